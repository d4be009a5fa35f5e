// Which settings have no effect beside the others.
#include "eval/idle_settings.h"

#include <gmock/gmock.h>

#include <set>

namespace depthgrid {
namespace {

using ::testing::Contains;
using ::testing::Not;

ExperimentOptions FromYaml(const std::string& text) {
  ExperimentOptions options;
  Config::FromText(text, "test").Read(options);
  return options;
}

std::set<std::string> IdleIn(const std::string& yaml) {
  std::set<std::string> keys;
  for (const IdleSetting& idle : IdleSettings(FromYaml(yaml))) keys.insert(idle.key);
  return keys;
}

// Each key with settings beside which it does nothing, and some beside which it does.
TEST(IdleSettings, AreThoseThatNothingReads) {
  struct Case {
    const char* key;
    const char* idle_in;
    const char* used_in;
  };
  const Case cases[] = {
      {"slam.jump_translation_m", "slam: {profile: orb_slam2}", "slam: {jump_rate_hz: 1}"},
      {"slam.jump_rotation_deg", "slam: {lost_rate_hz: 1}", "slam: {jump_rate_hz: 1}"},
      {"slam.lost_mean_s", "slam: {profile: orb_slam2}", "slam: {lost_rate_hz: 1}"},
      {"slam.relocalisation_translation_m", "slam: {jump_rate_hz: 1}", "slam: {lost_rate_hz: 1}"},
      {"sensor.noise_correlation_px", "sensor: {flying_pixels: 0.1}", "sensor: {noise: handa}"},
      {"sensor.grazing_limit_deg", "sensor: {noise: none}", "sensor: {noise: nguyen}"},
      {"sensor.hfov_deg", "sensor: {fx: 300, fy: 300, noise: handa}", "sensor: {fx: 300}"},
      {"mapper.fusion.slam_noise.jitter_m", "mapper: {fusion: {slam_noise: {source: profile}}}",
       "mapper: {fusion: {mode: kalman}}"},
      {"mapper.rounds.again", "mapper: {fusion: {mode: fixed}}",
       "mapper: {fusion: {mode: learned}}"},
      {"mapper.scan.band_rows", "mapper: {scan: {mode: centre_row}}",
       "mapper: {scan: {mode: row_band}}"},
  };
  for (const Case& one : cases) {
    EXPECT_THAT(IdleIn(one.idle_in), Contains(one.key));
    EXPECT_THAT(IdleIn(one.used_in), Not(Contains(one.key)));
  }
  EXPECT_THAT(IdleIn("{}"), Contains("mapper.scan.floor_z_m"));  // the scene's in every run
  EXPECT_THAT(IdleIn("mapper: {fusion: {slam_noise: {source: profile}}}"),
              Not(Contains("mapper.fusion.slam_noise.source")));
}

// Two experiments that differ in what is idle alone are one.
TEST(IdleSettings, AreLeftOutOfWhatMakesARun) {
  const auto plain = [](const std::string& yaml) {
    return ToYaml(WithoutIdleSettings(FromYaml(yaml)));
  };
  EXPECT_EQ(plain("slam: {jump_translation_m: 0.1, lost_mean_s: 4}"), plain("{}"));
  EXPECT_EQ(plain("sensor: {noise_correlation_px: 3, grazing_softness_deg: 2}"), plain("{}"));
  EXPECT_EQ(plain("sensor: {noise: handa, fx: 300, fy: 300, hfov_deg: 60}"),
            plain("sensor: {noise: handa, fx: 300, fy: 300}"));
  EXPECT_EQ(plain("mapper: {scan: {band_rows: 3}}"), plain("{}"));
  EXPECT_EQ(plain("mapper: {scan: {floor_z_m: 0.5}}"), plain("{}"));
  EXPECT_EQ(plain("mapper: {fusion: {mode: fixed}, rounds: {again: false}}"),
            plain("mapper: {fusion: {mode: fixed}}"));
  const std::string source = "mapper: {fusion: {slam_noise: {source: profile";
  EXPECT_EQ(plain(source + ", jitter_m: 1}}}"), plain(source + "}}}"));
  EXPECT_NE(plain(source + "}}}"), plain("{}"));
  EXPECT_NE(plain("slam: {jump_rate_hz: 1, jump_translation_m: 0.1}"),
            plain("slam: {jump_rate_hz: 1}"));
  EXPECT_NE(plain("sensor: {noise: handa, noise_correlation_px: 3}"),
            plain("sensor: {noise: handa}"));
}

}  // namespace
}  // namespace depthgrid
