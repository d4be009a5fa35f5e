// Settings of the SLAM error model sim/slam/slam_surrogate.h (equations: docs/slam_surrogate.md).
// Sigmas are standard deviations per axis; those of rotation are about the vertical (see
// tilt_share).
#pragma once

#include <array>

#include "mapper/core/options.h"

namespace depthgrid {

// A profile sets all other settings; keys given as well override it. sim/slam/slam_profiles.cc has
// the values and their sources.
enum class SlamProfile {
  kGroundTruth,  // no error at all
  kOrbSlam2,     // error sizes of the paper's Table 1
  kPlanarSlam,
  kPlanarSlamMh,
  kOrbSlam2Measured,  // fitted to runs of the real systems
  kPlanarSlamMeasured,
  kOrbSlam2Desk,  // ORB-SLAM2 on TUM fr2/desk, fitted to its error over time lags
};
// All profiles.
inline constexpr std::array kSlamProfiles = {
    ChoiceName<SlamProfile>{SlamProfile::kGroundTruth, "ground_truth"},
    ChoiceName<SlamProfile>{SlamProfile::kOrbSlam2, "orb_slam2"},
    ChoiceName<SlamProfile>{SlamProfile::kPlanarSlam, "planar_slam"},
    ChoiceName<SlamProfile>{SlamProfile::kPlanarSlamMh, "planar_slam_mh"},
    ChoiceName<SlamProfile>{SlamProfile::kOrbSlam2Measured, "orb_slam2_measured"},
    ChoiceName<SlamProfile>{SlamProfile::kPlanarSlamMeasured, "planar_slam_measured"},
    ChoiceName<SlamProfile>{SlamProfile::kOrbSlam2Desk, "orb_slam2_desk"}};

// The scenario presets precision, recall and delay of loop closures.
enum class LoopScenario {
  kNone,    // SLAM never closes a loop
  kTrue,    // each revisit is closed, at once
  kLate,    // each revisit is closed, 3 s later
  kMissed,  // half of the revisits are not closed
  kFalse,   // each revisit is closed, and half of all closures are false
};

struct SlamLoopOptions {
  LoopScenario scenario = LoopScenario::kNone;
  double recall = 0.0;     // share of revisits that are closed
  double precision = 1.0;  // share of closures that are true
  int delay_frames = 0;    // from the revisit to the report
  // Sigmas of the reported relative pose, from two loops of real runs (docs/slam_surrogate.md) with
  // total errors of 15 and 23 mm, 0.43 and 0.71 degrees.
  double sigma_translation_m = 0.011;
  double sigma_rotation_deg = 0.34;
  bool follow_false = false;  // whether false closures also correct SLAM's own estimate

  // A revisit is two frames this near with the camera elsewhere in between. The two real loops
  // joined views 0.30 m, 7 degrees and 0.67 m, 24 degrees apart.
  double max_distance_m = 0.6;
  double max_angle_deg = 25.0;
  double min_gap_s = 10.0;
  double repeat_s = 10.0;  // a lasting revisit is an opportunity again after this time

  void Visit(OptionsVisitor& v);
};

constexpr double kMostPivotM = 20.0;

struct SlamOptions {
  SlamProfile profile = SlamProfile::kGroundTruth;
  double drift_scale = 1.0;  // multiplies walk and drift; set by calibration

  // Rotation errors are about a point this far ahead of the camera: features tie the image to the
  // scene, so an error in rotation comes with one in translation.
  double pivot_m = 0.0;

  // Error of roll and pitch as a share of yaw's, except jitter: 0.2 to 0.4 in real runs.
  double tilt_share = 1.0;

  // White error of each live pose.
  double jitter_translation_m = 0.0;
  double jitter_rotation_deg = 0.0;
  // Slowly varying bias of the pose (Ornstein-Uhlenbeck): stationary sigma and correlation time.
  // Bounded, as when tracking follows a slightly distorted map.
  double bias_translation_m = 0.0;
  double bias_rotation_deg = 0.0;
  double bias_time_s = 1.0;
  // Random walk: white error of the motion, in one second.
  double walk_translation_m = 0.0;
  double walk_rotation_deg = 0.0;
  // Slowly varying bias of the velocity (Ornstein-Uhlenbeck), whose errors grow smoothly and
  // without bound: stationary sigma and correlation time.
  double drift_speed_mps = 0.0;
  double drift_turn_dps = 0.0;
  double drift_time_s = 10.0;
  // Jumps without loss of tracking, as when the local map changes.
  double jump_rate_hz = 0.0;
  double jump_translation_m = 0.0;
  double jump_rotation_deg = 0.0;
  // Losses of tracking, of exponentially distributed duration, and the jump at the relocalisation.
  double lost_rate_hz = 0.0;
  double lost_mean_s = 1.0;
  double relocalisation_translation_m = 0.0;
  double relocalisation_rotation_deg = 0.0;

  SlamLoopOptions loops;

  void Visit(OptionsVisitor& v);
};

// All settings of a profile.
SlamOptions ProfileOptions(SlamProfile profile);
// The loop settings of a scenario: precision, recall and delay; the rest as given.
SlamLoopOptions WithScenario(SlamLoopOptions options, LoopScenario scenario);

}  // namespace depthgrid
