// Frames come in even steps of time, but for pauses.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "mapper/core/median.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// The usual one of these steps, their median; 0 of none. Reorders them.
inline double UsualStepS(std::span<double> steps_s) {
  return steps_s.empty() ? 0.0 : UpperMedianAmong(steps_s);
}

// How many usual steps a step took: more than one where frames did not come. A recording that
// paused for longer than a thousand errs by no more. One where the usual step is not known, 0.
inline int StepsIn(double step_s, double usual_s) {
  constexpr double kMostSteps = 1000.0;
  if (!(usual_s > 0.0) || !(step_s > usual_s)) return 1;
  return static_cast<int>(std::min(std::round(step_s / usual_s), kMostSteps));
}

// How far frames move, in the mean.
class UsualMotion {
 public:
  void Add(const Pose2& motion) {
    way_m_ += motion.translation().norm();
    turn_rad_ += std::abs(motion.yaw_rad);
    ++motions_;
  }
  // How many frames at least would have gone so far; infinite if nothing moved before.
  double FramesFor(const Pose2& motion) const {
    const auto times = [this](double length, double sum) {
      if (length == 0.0) return 0.0;
      return sum > 0.0 ? length * motions_ / sum : std::numeric_limits<double>::infinity();
    };
    return std::max(times(motion.translation().norm(), way_m_),
                    times(std::abs(motion.yaw_rad), turn_rad_));
  }

 private:
  double way_m_ = 0.0;
  double turn_rad_ = 0.0;
  int motions_ = 0;
};

// A second at 30 Hz: pauses up to this count by the time alone, whatever moved.
constexpr int kFewSteps = 30;

// SLAM errs as it moves: over a pause in which it hardly did, by no more than over a few frames,
// however long it was. `steps` of time, and what SLAM moved by meanwhile.
inline int MovingStepsIn(int steps, const Pose2& motion, const UsualMotion& usual) {
  // Ways are rarely straight: chosen, of no measurement; what it gives is in docs/tried.md,
  // "Pauses".
  constexpr double kRoundabout = 2.0;
  if (steps <= kFewSteps) return steps;
  return static_cast<int>(std::clamp(std::ceil(kRoundabout * usual.FramesFor(motion)),
                                     double{kFewSteps}, double(steps)));
}

}  // namespace depthgrid
