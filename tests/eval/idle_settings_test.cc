// Which settings have no effect beside the others.
#include "eval/experiment/idle_settings.h"

#include <gmock/gmock.h>

#include <set>

namespace depthgrid {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
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
      {"slam.pivot_m", "slam: {jitter_translation_m: 0.1}", "slam: {jitter_rotation_deg: 1}"},
      {"slam.pivot_m",
       "slam: {profile: orb_slam2, drift_scale: 0, bias_rotation_deg: 0, "
       "jitter_rotation_deg: 0}",
       "slam: {drift_turn_dps: 1}"},
      {"slam.tilt_share", "slam: {jitter_rotation_deg: 1}", "slam: {bias_rotation_deg: 1}"},
      {"slam.tilt_share", "slam: {jump_rotation_deg: 1}",
       "slam: {jump_rotation_deg: 1, jump_rate_hz: 1}"},
      {"slam.bias_time_s", "slam: {jitter_rotation_deg: 1}", "slam: {bias_translation_m: 1}"},
      {"slam.drift_time_s", "slam: {walk_rotation_deg: 1}", "slam: {drift_speed_mps: 1}"},
      {"slam.drift_turn_dps", "slam: {profile: orb_slam2, drift_scale: 0}",
       "slam: {profile: orb_slam2}"},
      {"slam.drift_scale", "slam: {drift_scale: 0}", "slam: {drift_scale: 0, drift_turn_dps: 1}"},
      {"slam.loops.sigma_translation_m", "{}", "slam: {loops: {scenario: late}}"},
      {"slam.loops.delay_frames", "slam: {loops: {scenario: late, recall: 0}}",
       "slam: {loops: {recall: 0.5}}"},
      {"slam.loops.follow_false", "slam: {loops: {scenario: true}}",
       "slam: {loops: {scenario: false}}"},
      {"trajectory_seed", "trajectory: ./path.txt", "trajectory: path"},
      {"depth_seed", "sensor: {noise: handa, noise_scale: 0}",
       "sensor: {noise: handa, noise_scale: 0, grazing_softness_deg: 1}"},
      {"sensor.noise_correlation_px", "sensor: {noise: handa, noise_scale: 0}",
       "sensor: {noise: handa, noise_scale: 0.1}"},
      {"sensor.grazing_softness_deg", "sensor: {noise: handa, grazing_limit_deg: 90}",
       "sensor: {noise: handa, grazing_limit_deg: 89}"},
      {"slam.relocalisation_translation_m", "slam: {jump_rate_hz: 1}", "slam: {lost_rate_hz: 1}"},
      {"sensor.noise_correlation_px", "sensor: {flying_pixels: 0.1}", "sensor: {noise: handa}"},
      {"sensor.grazing_limit_deg", "sensor: {noise: none}", "sensor: {noise: nguyen}"},
      {"sensor.hfov_deg", "sensor: {fx: 300, fy: 300, noise: handa}", "sensor: {fx: 300}"},
      {"mapper.fusion.slam_noise.jitter_m", "mapper: {fusion: {slam_noise: {source: profile}}}",
       "mapper: {fusion: {mode: kalman}}"},
      {"mapper.rounds.again", "mapper: {fusion: {mode: fixed}}",
       "mapper: {fusion: {mode: learned}}"},
      {"mapper.loops.relocation.slip_deg", "mapper: {fusion: {mode: fixed, gain: [1, 0, 0]}}",
       "mapper: {fusion: {mode: fixed, gain: 0.2}}"},
      {"mapper.rounds.growth", "mapper: {rounds: {first_frames: 0}}", "{}"},
      {"mapper.keep.place_m", "mapper: {keep: {first_frames: 0}}", "{}"},
      {"mapper.grid.surface_radius_m", "mapper: {grid: {min_surface_share: 0}}", "{}"},
      {"mapper.grid.min_observations", "mapper: {grid: {raster: log_odds}}", "{}"},
      {"mapper.grid.earlier_scans", "mapper: {grid: {raster: log_odds}}", "{}"},
      {"mapper.grid.hit_weight", "mapper: {grid: {raster: log_odds, min_surface_share: 0}}",
       "mapper: {grid: {raster: log_odds}}"},
      {"mapper.match.search", "mapper: {method: paper, match: {stages: least_squares}}",
       "mapper: {method: paper}"},
      {"mapper.match.least_squares", "mapper: {method: paper, match: {stages: search}}",
       "mapper: {method: paper}"},
      {"mapper.match.information.surface_window_m", "mapper: {method: paper}",
       "mapper: {method: paper, match: {information: {source: surface}}}"},
      {"mapper.match.information.patch_m",
       "mapper: {method: paper, match: {information: {source: surface}}}",
       "mapper: {method: paper}"},
      {"mapper.loops.search.every_m", "mapper: {method: paper}",
       "mapper: {method: paper, loops: {search: {use: on}}}"},
      {"mapper.loops.search.every_m", "mapper: {loops: {search: {use: off}}}", "{}"},
      {"mapper.loops.relocation.window_m", "mapper: {loops: {relocation: {use: false}}}", "{}"},
      {"mapper.loops.use", "{}", "slam: {loops: {scenario: true}}"},
      {"mapper.loops.verify", "{slam: {loops: {scenario: true}}, mapper: {loops: {use: false}}}",
       "slam: {loops: {scenario: true}}"},
      {"mapper.scan.slice_half_height_m", "mapper: {scan: {mode: centre_row}}", "{}"},
      {"mapper.scan.drop_cut_ends", "mapper: {scan: {slice_half_height_m: 0}}", "{}"},
      {"metrics.navigability", "metrics: {navigation: false}", "{}"},
      {"mapper.scan.band_rows", "mapper: {scan: {mode: centre_row}}",
       "mapper: {scan: {mode: row_band}}"},
  };
  for (const Case& one : cases) {
    EXPECT_THAT(IdleIn(one.idle_in), Contains(one.key)) << one.idle_in;
    EXPECT_THAT(IdleIn(one.used_in), Not(Contains(one.key))) << one.used_in;
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
  EXPECT_EQ(plain("slam: {pivot_m: 2, tilt_share: 0.1, bias_time_s: 3, drift_time_s: 3}"),
            plain("{}"));
  EXPECT_EQ(plain("slam: {drift_scale: 0, walk_rotation_deg: 2, drift_speed_mps: 0.1}"),
            plain("{}"));
  EXPECT_EQ(plain("slam: {loops: {scenario: late, recall: 0, sigma_rotation_deg: 3}}"),
            plain("{}"));
  EXPECT_EQ(plain("{trajectory: ./a.txt, trajectory_seed: 4}"), plain("trajectory: ./a.txt"));
  EXPECT_NE(plain("slam: {profile: orb_slam2}"), plain("slam: {profile: planar_slam}"));
  EXPECT_NE(plain("{trajectory: a, trajectory_seed: 4}"), plain("trajectory: a"));
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

// What holds of true poses alone holds of all that says nothing but what they do not read.
TEST(IdleSettings, SeedsAreThoseOfExactPoses) {
  EXPECT_THAT(IdleIn("slam: {pivot_m: 2, loops: {sigma_translation_m: 1}}"), Contains("slam_seed"));
  EXPECT_THAT(IdleIn("slam: {profile: orb_slam2, drift_scale: 0, jitter_translation_m: 0, "
                     "jitter_rotation_deg: 0, bias_rotation_deg: 0, loops: {recall: 0}}"),
              Contains("slam_seed"));
  EXPECT_THAT(IdleIn("slam: {loops: {scenario: true}}"), Not(Contains("slam_seed")));
}

std::vector<std::string> DoubtsOfSet(const std::string& yaml, const std::vector<std::string>& set) {
  const auto with = [&](const std::vector<std::string>& some) {
    Config config = Config::FromText(yaml, "test");
    for (const std::string& assignment : some) config.Set(assignment);
    ExperimentOptions options;
    config.Read(options);
    return ToYaml(options);
  };
  return DoubtsOfOverrides(set, IdleSettings(FromYaml(with(set))), with);
}

// A run.yaml states all that a profile or scenario would set.
TEST(IdleSettings, PresetsOfWhatIsGivenAre) {
  const std::string all = ToYaml(FromYaml("slam: {profile: orb_slam2, loops: {scenario: true}}"));
  for (const std::string set : {"slam.loops.scenario=none", "slam.profile=ground_truth"}) {
    EXPECT_THAT(
        DoubtsOfSet(all, {set}),
        ElementsAre("--set " + set + ": has no effect because all keys that it sets are given"));
  }
  EXPECT_THAT(DoubtsOfSet(all, {"slam.loops.scenario=true"}), IsEmpty());
  EXPECT_THAT(DoubtsOfSet(all, {"slam={profile: ground_truth}"}), IsEmpty());
  const std::string some = "slam: {profile: orb_slam2, loops: {scenario: true, recall: 0.5}}";
  EXPECT_THAT(DoubtsOfSet(some, {"slam.loops.scenario=late"}), IsEmpty());
}

}  // namespace
}  // namespace depthgrid
