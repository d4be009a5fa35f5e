// Settings of Eq. 3 (docs/math.md, "Fusion").
#pragma once

#include <array>

#include "mapper/core/options.h"

namespace depthgrid {

enum class PriorMode {
  kRelative,  // start from SLAM's pose with the last correction
  kAbsolute,  // start from SLAM's pose itself
};

enum class SlamNoiseSource {
  kSetting,  // the values given here
  // An experiment's run computes the values from its profile of simulated SLAM noise; the mapper
  // itself uses the values as they are.
  kProfile,
};

enum class FusionMode {
  kFixed,     // K is a setting
  kKalman,    // K from SLAM's covariance (slam_noise) and the match's (from the matcher)
  kLearned,   // as kalman, with SLAM's covariance learnt online
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
  // The most accurate (docs/results.md); `fixed` allows setting the gain.
  FusionMode mode = FusionMode::kLearned;
  // K of Eq. 3: the share of the innovation taken, per base axis (forward, left, yaw). With
  // `fixed`, all zero uses SLAM's poses without matching, and all one the matched pose alone.
  // `adaptive` starts from it.
  std::array<double, 3> gain = {0.5, 0.5, 0.5};
  SlamNoiseOptions slam_noise;
  // Divisor of the match's information, for errors that its beams share: lowers the gain of
  // `kalman` and `learned`, and raises reported errors in every mode.
  double match_overconfidence = 1.0;
  // `learned`: whether the reported innovation_chi2 and motion_covariance scale the matches' noise
  // to their innovations (MatchNoise). Poses do not depend on it.
  bool judge_innovations = true;
  // Depth cameras: the part of a match's error that lasts while the view does, in units of the
  // match's variance; with 0 all of it is new in each frame. For the reported innovation_chi2 and
  // motion_covariance (PoseErrors); poses do not depend on it.
  double lasting_share = 1.0;
  // Angular uncertainty between walls and the prediction's least certain direction:
  // InformationFor().
  double tilt_rad = 0.001;
  // Innovations with a larger chi-square (3 degrees of freedom) are rejected; 0 accepts all. Off:
  // gates at 9-16 lock onto the prior and diverge (docs/math.md).
  double gate_chi2 = 0.0;
  // `adaptive`: rate at which the gain follows, within about 1/rate frames.
  double adaptive_rate = 0.02;

  // Only if SLAM's noise is learnt: otherwise wrong settings of it could explain the innovations.
  bool JudgesInnovations() const { return LearnsNoise() && judge_innovations; }
  // Noise is learnt from changes of the correction, so the prior must be relative.
  bool LearnsNoise() const { return mode == FusionMode::kLearned && prior == PriorMode::kRelative; }
  bool TrustsSlamAlone() const {
    return mode == FusionMode::kFixed && gain == std::array<double, 3>{};
  }
  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
