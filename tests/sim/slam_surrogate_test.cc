#include "sim/slam/slam_surrogate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mapper/io/config.h"
#include "sim/slam/slam_error.h"
#include "tests/sim/slam_paths.h"

namespace depthgrid {
namespace {

constexpr int kSeeds = 300;

// Mean square per axis of the error of the live pose at a frame, over many seeds.
struct Spread {
  double translation_m = 0.0;
  double rotation_deg = 0.0;
};
Spread SpreadAt(const Trajectory& truth, const SlamOptions& options, int frame) {
  double translation = 0.0;
  double rotation = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const SlamOutput output = DisturbTrajectory(truth, options, static_cast<std::uint64_t>(seed));
    const auto i = static_cast<std::size_t>(frame);
    const Pose3 error = Between(truth[i].world_from_camera, *output.live[i].slam_from_camera);
    translation += error.translation.squaredNorm() / (3.0 * kSeeds);
    rotation += LogRotation(error.rotation).squaredNorm() / (3.0 * kSeeds);
  }
  return {std::sqrt(translation), DegFromRad(std::sqrt(rotation))};
}

// Three standard errors of a standard deviation estimated from 3 axes x kSeeds draws.
const double kTolerance = 3.0 / std::sqrt(2.0 * 3.0 * kSeeds);

void ExpectRelative(double measured, double declared) {
  EXPECT_NEAR(measured / declared, 1.0, kTolerance) << measured << " against " << declared;
}

TEST(SlamSurrogate, WithoutErrorGivesTheTruthBitForBit) {
  const Trajectory truth = Circling(1.2);
  const SlamOutput output = DisturbTrajectory(truth, ProfileOptions(SlamProfile::kGroundTruth), 7);
  ASSERT_EQ(output.live.size(), truth.size());
  EXPECT_EQ(output.final, truth);
  EXPECT_TRUE(output.loops.empty());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(*output.live[i].slam_from_camera, truth[i].world_from_camera);
    EXPECT_EQ(output.live[i].epoch, 0);
  }
}

TEST(SlamSurrogate, EveryOtherProfileErrs) {
  const Trajectory truth = Circling(0.2);
  for (const auto& [profile, name] : kSlamProfiles) {
    if (profile == SlamProfile::kGroundTruth) continue;
    const SlamOutput output = DisturbTrajectory(truth, ProfileOptions(profile), 7);
    ASSERT_EQ(output.live.size(), truth.size()) << name;
    EXPECT_NE(*output.live.back().slam_from_camera, truth.back().world_from_camera) << name;
  }
}

TEST(SlamSurrogate, JitterHasItsSigmaAndNoMemory) {
  SlamOptions options;
  options.jitter_translation_m = 0.003;
  options.jitter_rotation_deg = 0.1;
  const Trajectory truth = Standing(1000);
  const SlamOutput output = DisturbTrajectory(truth, options, 3);
  double square = 0.0;
  double lagged = 0.0;
  double rotation = 0.0;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Pose3 error = Between(truth[i].world_from_camera, *output.live[i].slam_from_camera);
    square += error.translation.squaredNorm();
    lagged += error.translation.dot(before);
    rotation += LogRotation(error.rotation).squaredNorm();
    before = error.translation;
  }
  EXPECT_NEAR(std::sqrt(square / 2997.0), 0.003, 0.003 * 0.04);
  EXPECT_NEAR(DegFromRad(std::sqrt(rotation / 2997.0)), 0.1, 0.1 * 0.04);
  EXPECT_NEAR(lagged / square, 0.0, 3.0 / std::sqrt(2997.0));
  EXPECT_EQ(output.live[0].slam_from_camera, truth[0].world_from_camera);
}

TEST(SlamSurrogate, WalkGrowsWithTheRootOfTime) {
  SlamOptions options;
  options.walk_translation_m = 0.01;
  options.walk_rotation_deg = 0.1;
  options.drift_scale = 2.0;
  const Trajectory truth = Standing(481);
  for (const int frame : {30, 120, 480}) {
    const Spread spread = SpreadAt(truth, options, frame);
    ExpectRelative(spread.translation_m, 0.02 * std::sqrt(frame / 30.0));
    ExpectRelative(spread.rotation_deg, 0.2 * std::sqrt(frame / 30.0));
  }
}

// The walk is that of the time that passed, not of the frames.
TEST(SlamSurrogate, WalkDoesNotDependOnTheFrameRate) {
  SlamOptions options;
  options.walk_translation_m = 0.01;
  ExpectRelative(SpreadAt(Standing(33, 0.25), options, 32).translation_m, 0.01 * std::sqrt(8.0));
}

// A pose bias that starts at 0 has variance s^2 (1 - exp(-2 t / tau)).
TEST(SlamSurrogate, BiasOfThePoseIsBounded) {
  SlamOptions options;
  options.bias_translation_m = 0.02;
  options.bias_rotation_deg = 0.3;
  options.bias_time_s = 2.0;
  const Trajectory truth = Standing(601);
  for (const int frame : {15, 60, 600}) {
    const double settled = std::sqrt(-std::expm1(-2.0 * frame / 30.0 / options.bias_time_s));
    const Spread spread = SpreadAt(truth, options, frame);
    ExpectRelative(spread.translation_m, 0.02 * settled);
    ExpectRelative(spread.rotation_deg, 0.3 * settled);
  }
}

TEST(SlamSurrogate, BiasForgetsWithItsCorrelationTime) {
  SlamOptions options;
  options.bias_translation_m = 0.02;
  options.bias_time_s = 0.5;
  const auto errors = DrawFrameErrors(Standing(6001), options, 5);
  double square = 0.0;
  double lagged = 0.0;
  constexpr std::size_t kLag = 15;  // 0.5 s
  for (std::size_t i = 1; i + kLag < errors.size(); ++i) {
    square += errors[i].offset.translation.squaredNorm();
    lagged += errors[i].offset.translation.dot(errors[i + kLag].offset.translation);
  }
  EXPECT_NEAR(std::sqrt(square / (3.0 * 6000)), 0.02, 0.002);
  EXPECT_NEAR(lagged / square, std::exp(-1.0), 0.08);
}

// Var of the integral of an Ornstein-Uhlenbeck process: 2 s^2 tau^2 (t/tau - 1 + exp(-t/tau)).
TEST(SlamSurrogate, DriftIntegratesAStationaryBiasOfTheRate) {
  SlamOptions options;
  options.drift_speed_mps = 0.02;
  options.drift_turn_dps = 0.0;
  options.drift_time_s = 2.0;
  const Trajectory truth = Standing(601);
  for (const int frame : {3, 60, 600}) {
    const double x = frame / 30.0 / options.drift_time_s;
    const double variance = 2.0 * std::pow(0.02 * 2.0, 2) * (x - 1.0 + std::exp(-x));
    ExpectRelative(SpreadAt(truth, options, frame).translation_m, std::sqrt(variance));
  }
}

TEST(SlamSurrogate, JumpsAndLossesComeAtTheirRates) {
  SlamOptions options;
  options.jump_rate_hz = 0.5;
  options.jump_translation_m = 0.05;
  options.lost_rate_hz = 0.2;
  options.lost_mean_s = 0.8;
  options.relocalisation_translation_m = 0.1;
  const Trajectory truth = Standing(3001);
  double jumps = 0.0;
  double jump_square = 0.0;
  double bursts = 0.0;
  double lost_frames = 0.0;
  double landing_square = 0.0;
  constexpr int kRuns = 40;
  for (int seed = 0; seed < kRuns; ++seed) {
    for (const FrameErrors& error :
         DrawFrameErrors(truth, options, static_cast<std::uint64_t>(seed))) {
      lost_frames += error.lost ? 1 : 0;
      if (error.relocalised) {
        ++bursts;
        landing_square += error.motion.translation.squaredNorm() / 3.0;
      } else if (!error.motion.translation.isZero(0.0)) {
        ++jumps;
        jump_square += error.motion.translation.squaredNorm() / 3.0;
      }
    }
  }
  const double seconds = kRuns * 100.0;
  const double tracked_s = seconds - lost_frames / 30.0;
  EXPECT_NEAR(jumps / seconds, 0.5, 0.05);
  EXPECT_NEAR(std::sqrt(jump_square / jumps), 0.05, 0.002);
  EXPECT_NEAR(bursts / tracked_s, 0.2, 0.025);
  // A burst lasts to the first frame after its time is over: half a frame more in the mean.
  EXPECT_NEAR(lost_frames / 30.0 / bursts, 0.8 + 0.5 / 30.0, 0.1);
  EXPECT_NEAR(std::sqrt(landing_square / bursts), 0.1, 0.006);
}

// What calibrates drift leaves jumps as large as they are.
TEST(SlamSurrogate, TheScaleOfDriftIsNotThatOfJumps) {
  SlamOptions options;
  options.jump_rate_hz = 0.5;
  options.jump_translation_m = 0.1;
  const Trajectory truth = Standing(900);
  const SlamOutput plain = DisturbTrajectory(truth, options, 5);
  options.drift_scale = 3.0;
  const SlamOutput scaled = DisturbTrajectory(truth, options, 5);
  ASSERT_NE(*plain.live.back().slam_from_camera, truth.back().world_from_camera);
  EXPECT_EQ(*scaled.live.back().slam_from_camera, *plain.live.back().slam_from_camera);
}

TEST(SlamSurrogate, LostFramesHaveNoPoseAndRelocalisationStartsAnEpoch) {
  SlamOptions options;
  options.lost_rate_hz = 0.3;
  const Trajectory truth = Standing(1500);
  const SlamOutput output = DisturbTrajectory(truth, options, 2);
  std::size_t tracked = 0;
  int epochs = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(output.live[i].stamp_s, truth[i].stamp_s);
    tracked += output.live[i].slam_from_camera ? 1 : 0;
    if (i == 0) continue;
    const bool found = output.live[i].slam_from_camera && !output.live[i - 1].slam_from_camera;
    EXPECT_EQ(output.live[i].epoch - output.live[i - 1].epoch, found ? 1 : 0);
    epochs += found ? 1 : 0;
  }
  EXPECT_GT(epochs, 3);
  EXPECT_EQ(output.final.size(), tracked);
  EXPECT_LT(tracked, truth.size());
}

TEST(SlamSurrogate, RotationErrorsTurnAboutThePivot) {
  const Pose3 error = PivotedMotion({0.01, -0.02, 0.005}, Eigen::Vector3d::Zero(), 1.9);
  const Eigen::Vector3d pivot(0, 0, 1.9);
  EXPECT_LT((error * pivot - pivot).norm(), 1e-15);
  EXPECT_GT(error.translation.norm(), 0.03);
}

TEST(SlamSurrogate, EffectsDoNotDisturbEachOther) {
  const Trajectory truth = Circling(1.2);
  SlamOptions options = ProfileOptions(SlamProfile::kOrbSlam2);
  const auto all = DrawFrameErrors(truth, options, 4);
  options.walk_translation_m = 0.0;
  options.walk_rotation_deg = 0.0;
  options.drift_speed_mps = 0.0;
  options.drift_turn_dps = 0.0;
  options.loops = {};
  const auto jitter_only = DrawFrameErrors(truth, options, 4);
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_EQ(all[i].offset, jitter_only[i].offset);
  EXPECT_EQ(DisturbTrajectory(truth, options, 4).live, DisturbTrajectory(truth, options, 4).live);
  EXPECT_NE(DisturbTrajectory(truth, options, 4).live, DisturbTrajectory(truth, options, 5).live);
}

TEST(SlamOptions, AProfileIsOverriddenByKeysBesideIt) {
  SlamOptions options;
  Config::FromText(
      "jitter_translation_m: 0.5\nloops: {scenario: late, recall: 0.25}\n"
      "profile: orb_slam2_measured",
      "x")
      .Read(options);
  SlamOptions expected = ProfileOptions(SlamProfile::kOrbSlam2Measured);
  expected.jitter_translation_m = 0.5;
  expected.loops = WithScenario(expected.loops, LoopScenario::kLate);
  expected.loops.recall = 0.25;
  EXPECT_EQ(ToYaml(options), ToYaml(expected));
  SlamOptions again;
  Config::FromText(ToYaml(options), "x").Read(again);
  EXPECT_EQ(ToYaml(again), ToYaml(expected));
}

}  // namespace
}  // namespace depthgrid
