#include "eval/run/slam_noise.h"

#include <gtest/gtest.h>

#include "eval/run/experiment.h"
#include "mapper/core/angle.h"
#include "mapper/core/options.h"
#include "sim/scene/scene.h"

namespace depthgrid {
namespace {

TEST(SlamNoise, OfTruthIsNothing) {
  const SlamNoiseOptions noise = NoiseOf(ProfileOptions(SlamProfile::kGroundTruth));
  EXPECT_EQ(noise.jitter_m, 0.0);
  EXPECT_EQ(noise.jitter_rad, 0.0);
  EXPECT_EQ(noise.walk_m_per_sqrt_s, 0.0);
  EXPECT_EQ(noise.walk_rad_per_sqrt_s, 0.0);
}

TEST(SlamNoise, AddsWhatGrowsWithTime) {
  SlamOptions slam;
  slam.jitter_translation_m = 0.003;
  slam.walk_translation_m = 0.01;
  slam.drift_speed_mps = 0.002;
  slam.drift_time_s = 8.0;
  slam.drift_scale = 2.0;
  slam.bias_translation_m = 0.01;
  slam.bias_time_s = 2.0;
  slam.jump_rate_hz = 0.25;
  slam.jump_translation_m = 0.04;
  const SlamNoiseOptions noise = NoiseOf(slam);
  EXPECT_NEAR(noise.jitter_m, 0.003, 1e-12);
  // 4 (1e-4 + 2 * 4e-6 * 8) + 2 * 1e-4 / 2 + 0.25 * 1.6e-3
  EXPECT_NEAR(noise.walk_m_per_sqrt_s, std::sqrt(6.56e-4 + 1e-4 + 4e-4), 1e-12);
  EXPECT_EQ(noise.walk_rad_per_sqrt_s, 0.0);
}

TEST(SlamNoise, TurnsShiftTheCameraToTheLeft) {
  SlamOptions slam;
  slam.pivot_m = 2.0;
  slam.jitter_rotation_deg = 0.1;
  const SlamNoiseOptions noise = NoiseOf(slam);
  EXPECT_NEAR(noise.jitter_rad, RadFromDeg(0.1), 1e-15);
  EXPECT_NEAR(noise.jitter_m, std::sqrt(0.5) * 2.0 * RadFromDeg(0.1), 1e-12);
}

TEST(SlamNoise, IsTakenFromTheProfileOnlyWhenAskedFor) {
  ExperimentOptions options;
  options.slam = ProfileOptions(SlamProfile::kOrbSlam2);
  const SlamNoiseOptions setting;
  EXPECT_EQ(Completed(options, Scene{}).mapper.fusion.slam_noise.walk_m_per_sqrt_s,
            setting.walk_m_per_sqrt_s);
  options.mapper.fusion.slam_noise.source = SlamNoiseSource::kProfile;
  EXPECT_EQ(Completed(options, Scene{}).mapper.fusion.slam_noise.walk_m_per_sqrt_s,
            NoiseOf(options.slam).walk_m_per_sqrt_s);
}

TEST(SlamNoise, OfTheLargestDriftIsASetting) {
  for (const SlamProfile profile :
       {SlamProfile::kOrbSlam2, SlamProfile::kPlanarSlam, SlamProfile::kGroundTruth}) {
    SlamOptions slam = ProfileOptions(profile);
    slam.drift_scale = 1000.0;  // as much as slam.drift_scale may be
    MapperOptions mapper;
    mapper.fusion.slam_noise = NoiseOf(slam);
    EXPECT_NO_THROW(RequireInRange(mapper, "mapper"));
  }
}

}  // namespace
}  // namespace depthgrid
