#include "mapper/fuse/fusion_options.h"

namespace depthgrid {

void SlamNoiseOptions::Visit(OptionsVisitor& v) {
  // Large, for simulated profiles with scaled-up drift.
  constexpr double kMost = 1e6;
  v.Choice("source", source,
           {{SlamNoiseSource::kSetting, "setting"}, {SlamNoiseSource::kProfile, "profile"}},
           "the values below, or those of the run's slam.profile in their place");
  v.Number("jitter_m", jitter_m, {0.0, kMost}, "white error of each pose, metres");
  v.Number("jitter_rad", jitter_rad, {0.0, kMost}, "white error of each heading, radians");
  v.Number("walk_m_per_sqrt_s", walk_m_per_sqrt_s, {0.0, kMost}, "random walk of the position");
  v.Number("walk_rad_per_sqrt_s", walk_rad_per_sqrt_s, {0.0, kMost}, "random walk of the heading");
  v.Number("path_share", path_share, {0.0, 1.0}, "metres of error per metre travelled");
  v.Number("turn_share", turn_share, {0.0, 1.0}, "radians of error per radian turned");
}

void FusionOptions::Visit(OptionsVisitor& v) {
  v.Choice("prior", prior, {{PriorMode::kRelative, "relative"}, {PriorMode::kAbsolute, "absolute"}},
           "whether the last correction of SLAM's poses is carried on to the next frame");
  v.Choice("mode", mode,
           {{FusionMode::kFixed, "fixed"},
            {FusionMode::kKalman, "kalman"},
            {FusionMode::kLearned, "learned"},
            {FusionMode::kAdaptive, "adaptive"},
            {FusionMode::kOracle, "oracle"}},
           "what sets the gain");
  v.PerAxis("gain", gain, {0.0, 1.0}, "K of Eq. 3: 0 takes SLAM's poses, 1 the matched ones");
  v.Group("slam_noise", slam_noise,
          "how the error of SLAM's motion grows: for kalman's gain, and for the errors that all "
          "modes but learned state");
  v.Number("match_overconfidence", match_overconfidence, {0.01, 1e4},
           "the match's information is divided by this, for kalman's and learned's gain and for "
           "the stated errors");
  v.Flag("judge_innovations", judge_innovations,
         "learned: whether stated errors take matches to be as noisy as innovations show");
  v.Number("lasting_share", lasting_share, {0.0, 100.0},
           "depth cameras: stated errors take this much of a match's variance to last while the "
           "view does");
  v.Number(
      "tilt_rad", tilt_rad, {0.0, 1.0},
      "uncertainty of a wall's direction against the one that the prediction knows least; 0: none");
  v.Number("gate_chi2", gate_chi2, {0.0, 1e6},
           "innovations with a larger chi-square are rejected; 0 takes all");
  v.Number("adaptive_rate", adaptive_rate, {1e-4, 0.5}, "adaptive: how fast the gain follows");
}

}  // namespace depthgrid
