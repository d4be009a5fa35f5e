// The values of each SLAM profile; docs/slam_surrogate.md has their sources.
#include "mapper/core/error.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {
namespace {

// Shared by the profiles whose drift is calibrated to the paper's Table 1. The error of single
// poses is that of the recorded Planar-SLAM run: 3 mm and 0.1 degrees from frame to frame. The
// drift is nearly all a slowly varying rate, so that it stays smooth from frame to frame (1 mm)
// however much it is scaled. At scale 1 the translation error over time lags of 0.03 to 60 s is
// that of ORB-SLAM2 on TUM fr2/desk within a factor of 1.3. Table 1 does not give rotation: it is
// chosen so that yaw errs by 7 degrees per metre, a fifth of that in the recorded ORB-SLAM2 runs,
// in which a drift of Table 1's size would turn the map by 15 degrees.
SlamOptions CalibratedBase() {
  SlamOptions options;
  options.pivot_m = 1.9;
  options.tilt_share = 0.25;
  options.jitter_translation_m = 0.0005;
  options.jitter_rotation_deg = 0.045;
  options.bias_rotation_deg = 0.15;
  options.bias_time_s = 1.0;
  options.walk_translation_m = 0.0001;
  options.walk_rotation_deg = 0.001;
  options.drift_speed_mps = 0.0011;
  options.drift_turn_dps = 0.011;
  options.drift_time_s = 10.0;
  options.loops = WithScenario({}, LoopScenario::kTrue);
  return options;
}

// The scales are for the living room; experiments in other rooms set their own, found by
//   depthgrid slam-calibrate ROOM --set slam.profile=PROFILE --target TABLE_1
SlamOptions OrbSlam2() {
  SlamOptions options = CalibratedBase();
  options.drift_scale = 48.4;
  return options;
}

// Planes constrain the rotation better than points: half the rotation for the same translation.
SlamOptions PlanarSlam() {
  SlamOptions options = CalibratedBase();
  options.drift_scale = 37.5;
  options.walk_rotation_deg *= 0.5;
  options.drift_turn_dps *= 0.5;
  return options;
}

// The Manhattan frame gives each pose its rotation from the walls, so rotation does not drift.
SlamOptions PlanarSlamMh() {
  SlamOptions options = CalibratedBase();
  options.drift_scale = 35.2;
  options.walk_rotation_deg = 0.0;
  options.drift_turn_dps = 0.0;
  return options;
}

// depthgrid slam-fit truth_rich.txt orb_rich_a/live.txt truth_mid.txt orb_mid_a/live.txt
// 56 s of tracking: 20 jumps, 2 losses, 2 corrections (left out).
SlamOptions OrbSlam2Measured() {
  SlamOptions options;
  options.pivot_m = 1.89;
  options.tilt_share = 0.398;
  options.jitter_translation_m = 0.000409;
  options.jitter_rotation_deg = 0.102;
  options.bias_translation_m = 0.0053;
  options.bias_rotation_deg = 0.319;
  options.bias_time_s = 0.5;
  options.jump_rate_hz = 0.359;
  options.jump_translation_m = 0.015;
  options.jump_rotation_deg = 1.28;
  options.lost_rate_hz = 0.0359;
  options.lost_mean_s = 2.13;
  options.relocalisation_translation_m = 0.0254;
  options.relocalisation_rotation_deg = 6.64;
  options.loops = WithScenario({}, LoopScenario::kTrue);
  return options;
}

// depthgrid slam-fit truth_rich.txt pl1_rich_a/live.txt
// 30 s of tracking: 5 jumps.
SlamOptions PlanarSlamMeasured() {
  SlamOptions options;
  options.pivot_m = 1.91;
  options.tilt_share = 0.359;
  options.jitter_translation_m = 0.000418;
  options.jitter_rotation_deg = 0.0592;
  options.bias_rotation_deg = 0.205;
  options.bias_time_s = 1.0;
  options.drift_speed_mps = 0.000917;
  options.drift_time_s = 5.0;
  options.jump_rate_hz = 0.167;
  options.jump_translation_m = 0.00941;
  options.jump_rotation_deg = 0.325;
  options.loops = WithScenario({}, LoopScenario::kTrue);
  return options;
}

// From the error over lags of 0.033 to 60 s on TUM fr2/desk (18.7 m, 99 s), reproduced within 25 %.
// The pivot is the distance of the desk, with which rotation and translation errors agree. The
// trajectory was the fully corrected one, so no loops are left to close.
SlamOptions OrbSlam2Desk() {
  SlamOptions options;
  options.pivot_m = 0.7;
  options.jitter_translation_m = 0.0004;
  options.jitter_rotation_deg = 0.11;
  options.bias_translation_m = 0.002;
  options.bias_rotation_deg = 0.143;
  options.bias_time_s = 0.5;
  options.walk_translation_m = 0.001;
  options.walk_rotation_deg = 0.118;
  options.drift_speed_mps = 0.0006;
  options.drift_time_s = 20.0;
  return options;
}

SlamOptions SettingsOf(SlamProfile profile) {
  switch (profile) {
    case SlamProfile::kGroundTruth:
      return {};
    case SlamProfile::kOrbSlam2:
      return OrbSlam2();
    case SlamProfile::kPlanarSlam:
      return PlanarSlam();
    case SlamProfile::kPlanarSlamMh:
      return PlanarSlamMh();
    case SlamProfile::kOrbSlam2Measured:
      return OrbSlam2Measured();
    case SlamProfile::kPlanarSlamMeasured:
      return PlanarSlamMeasured();
    case SlamProfile::kOrbSlam2Desk:
      return OrbSlam2Desk();
  }
  Broken("a SLAM profile has its settings");
}

}  // namespace

SlamOptions ProfileOptions(SlamProfile profile) {
  SlamOptions options = SettingsOf(profile);
  options.profile = profile;
  return options;
}

}  // namespace depthgrid
