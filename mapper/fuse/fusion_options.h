// Settings of Eq. 3 (docs/math.md, "Fusion").
#pragma once

#include <array>

#include "mapper/core/options.h"

namespace depthgrid {

enum class PriorMode {
  kRelative,  // the last correction of SLAM's poses is carried on
  kAbsolute,  // every frame starts from SLAM's pose itself
};

enum class SlamNoiseSource {
  kSetting,  // the values beside it
  // Worked out from the profile that SLAM was disturbed with, and put there, by an experiment's
  // run; the mapper itself takes the values as they are.
  kProfile,
};

enum class FusionMode {
  kFixed,     // K is a setting
  kKalman,    // K from SLAM's covariance (slam_noise) and the match's (from the matcher)
  kLearned,   // K as with kalman, SLAM's covariance learnt from the matches as well
  kAdaptive,  // K per axis such that the innovations become white
  kOracle,    // K given from outside, for experiments that know the truth
};

// How the error of SLAM's motion grows from one frame to the next. Jitter is white noise of each
// pose, the rest grows with time, path and turning. Defaults: ORB-SLAM2 on TUM fr2/desk, error of
// relative motion over 0.03-60 s (docs/slam_surrogate.md, `orb_slam2_desk`).
struct SlamNoiseOptions {
  SlamNoiseSource source = SlamNoiseSource::kSetting;
  double jitter_m = 0.0024;
  double jitter_rad = 0.0035;
  double walk_m_per_sqrt_s = 0.007;
  double walk_rad_per_sqrt_s = 0.0035;
  double path_share = 0.0;  // metres of error per metre travelled
  double turn_share = 0.0;  // radians of error per radian turned

  void Visit(OptionsVisitor& v);
};

struct FusionOptions {
  PriorMode prior = PriorMode::kRelative;
  // The most accurate (docs/results.md); `fixed` makes the gain a knob.
  FusionMode mode = FusionMode::kLearned;
  // K of Eq. 3: the share of the innovation taken, per base axis (forward, left, yaw). With
  // `fixed`, all zero takes SLAM's poses as they are and matches nothing, and all one takes the
  // matched pose whole. `adaptive` starts from it.
  std::array<double, 3> gain = {0.5, 0.5, 0.5};
  SlamNoiseOptions slam_noise;
  // The match's information is divided by this, for errors its beams have in common: `kalman` and
  // `learned` take less of it, and in every mode errors are told as larger.
  double match_overconfidence = 1.0;
  // `learned`: whether what is told of the errors, innovation_chi2 and motion_covariance, takes
  // matches for as noisy as their innovations show (MatchNoise). No pose depends on it.
  bool judge_innovations = true;
  // What is seen is not told to run along the direction that the prediction knows least better than
  // this: InformationFor().
  double tilt_rad = 0.001;
  // Innovations with a larger chi-square (3 degrees of freedom) are not taken; 0 takes all. Off:
  // gates at 9-16 lock onto the prior and diverge (docs/math.md).
  double gate_chi2 = 0.0;
  // `adaptive`: how fast the gain follows; about 1/rate frames.
  double adaptive_rate = 0.02;

  // With SLAM's noise from a setting it could as well be that which is wrong.
  bool JudgesInnovations() const { return mode == FusionMode::kLearned && judge_innovations; }
  bool TrustsSlamAlone() const {
    return mode == FusionMode::kFixed && gain == std::array<double, 3>{};
  }
  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
