#include "sim/slam/slam_options.h"

namespace depthgrid {
namespace {

constexpr Interval kMetres = {0.0, 10.0};
constexpr Interval kDegrees = {0.0, 90.0};
constexpr Interval kCorrelationS = {0.01, 1e6};

}  // namespace

void SlamLoopOptions::Visit(OptionsVisitor& v) {
  const LoopScenario before = scenario;
  v.Choice("scenario", scenario,
           {{LoopScenario::kNone, "none"},
            {LoopScenario::kTrue, "true"},
            {LoopScenario::kLate, "late"},
            {LoopScenario::kMissed, "missed"},
            {LoopScenario::kFalse, "false"}},
           "presets recall, precision and delay_frames");
  if (scenario != before) *this = WithScenario(*this, scenario);
  v.Number("recall", recall, {0.0, 1.0}, "share of revisits that are closed");
  // Below 0.05 a true closure would bring more than 19 false ones.
  v.Number("precision", precision, {0.05, 1.0}, "share of closures that are true");
  v.Number("delay_frames", delay_frames, {0, 1e6},
           "frames from the revisit to the report of its closure");
  v.Number("sigma_translation_m", sigma_translation_m, kMetres,
           "sigma of a closure's measured relative pose");
  v.Number("sigma_rotation_deg", sigma_rotation_deg, kDegrees,
           "sigma of a closure's measured relative pose");
  v.Flag("follow_false", follow_false, "whether SLAM's own estimate is bent by its false closures");
  // Positive, as view distances are divided by these. Use the scenario `none` for no loops.
  v.Number("max_distance_m", max_distance_m, {0.001, 10.0},
           "a revisit is nearer than this to the old view");
  v.Number("max_angle_deg", max_angle_deg, {0.01, 180.0}, "and turned by less than this from it");
  v.Number("min_gap_s", min_gap_s, {0.0, 1e6}, "and at least this much later than it");
  v.Number("repeat_s", repeat_s, {0.1, 1e6},
           "a revisit that lasts is offered again after this time");
}

SlamLoopOptions WithScenario(SlamLoopOptions options, LoopScenario scenario) {
  options.scenario = scenario;
  options.recall = scenario == LoopScenario::kNone     ? 0.0
                   : scenario == LoopScenario::kMissed ? 0.5
                                                       : 1.0;
  options.precision = scenario == LoopScenario::kFalse ? 0.5 : 1.0;
  options.delay_frames = scenario == LoopScenario::kLate ? 90 : 0;
  return options;
}

void SlamOptions::Visit(OptionsVisitor& v) {
  const SlamProfile before = profile;
  v.Choice("profile", profile, kSlamProfiles,
           "sets all keys below; keys that are given override it");
  if (profile != before) *this = ProfileOptions(profile);
  v.Number("drift_scale", drift_scale, {0.0, 1000.0}, "multiplies walk and drift");
  v.Number("pivot_m", pivot_m, {0.0, kMostPivotM},
           "rotation errors turn about a point this far ahead of the camera");
  v.Number("tilt_share", tilt_share, {0.0, 1.0}, "roll and pitch errors as a share of yaw's");
  v.Number("jitter_translation_m", jitter_translation_m, kMetres,
           "white error of each pose, sigma");
  v.Number("jitter_rotation_deg", jitter_rotation_deg, kDegrees, "white error of each pose, sigma");
  v.Number("bias_translation_m", bias_translation_m, kMetres,
           "slowly varying bias of the pose, sigma");
  v.Number("bias_rotation_deg", bias_rotation_deg, kDegrees,
           "slowly varying bias of the pose, sigma");
  v.Number("bias_time_s", bias_time_s, kCorrelationS, "correlation time of the bias");
  v.Number("walk_translation_m", walk_translation_m, kMetres, "random walk in one second, sigma");
  v.Number("walk_rotation_deg", walk_rotation_deg, kDegrees, "random walk in one second, sigma");
  v.Number("drift_speed_mps", drift_speed_mps, kMetres, "slowly varying bias of the speed, sigma");
  v.Number("drift_turn_dps", drift_turn_dps, kDegrees,
           "slowly varying bias of the turn rate, sigma");
  v.Number("drift_time_s", drift_time_s, kCorrelationS, "correlation time of the drift");
  v.Number("jump_rate_hz", jump_rate_hz, {0.0, 30.0}, "jumps per second while tracking");
  v.Number("jump_translation_m", jump_translation_m, kMetres, "sigma of each jump");
  v.Number("jump_rotation_deg", jump_rotation_deg, kDegrees, "sigma of each jump");
  v.Number("lost_rate_hz", lost_rate_hz, {0.0, 30.0}, "how often per second tracking is lost");
  v.Number("lost_mean_s", lost_mean_s, {0.0, 1e4}, "mean time until tracking is found again");
  v.Number("relocalisation_translation_m", relocalisation_translation_m, kMetres,
           "sigma of the jump when tracking is found again");
  v.Number("relocalisation_rotation_deg", relocalisation_rotation_deg, kDegrees,
           "sigma of the jump when tracking is found again");
  v.Group("loops", loops, "loop closures");
}

}  // namespace depthgrid
