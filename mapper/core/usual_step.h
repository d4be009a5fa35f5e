// The usual time step between frames, and how many steps a pause counts as.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "mapper/core/median.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// The median step; 0 for none. Reorders the steps.
inline double UsualStepS(std::span<double> steps_s) {
  return steps_s.empty() ? 0.0 : UpperMedianAmong(steps_s);
}

// The same of the steps from one item to the next; `stamp_s` is a projection, such as
// &Item::stamp_s.
template <typename Items, typename Projection>
double UsualStepBetween(const Items& items, Projection stamp_s) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < items.size(); ++i) {
    steps_s.push_back(std::invoke(stamp_s, items[i]) - std::invoke(stamp_s, items[i - 1]));
  }
  return UsualStepS(steps_s);
}

// The length of a step in usual steps: more than one where frames are missing, at most a thousand
// (SLAM's error over a longer pause is not taken to grow further). 1 where usual_s is unknown (0).
inline int StepsIn(double step_s, double usual_s) {
  constexpr double kMostSteps = 1000.0;
  if (!(usual_s > 0.0) || !(step_s > usual_s)) return 1;
  return static_cast<int>(std::min(std::round(step_s / usual_s), kMostSteps));
}

// Mean motion per frame.
class UsualMotion {
 public:
  void Add(const Pose2& motion) {
    way_m_ += motion.translation().norm();
    turn_rad_ += std::abs(motion.yaw_rad);
    ++motions_;
  }
  double WayPerFrameM() const { return motions_ > 0 ? way_m_ / motions_ : 0.0; }
  // The number of mean frames needed for a motion, by way or by turn, the larger; infinite if
  // nothing moved before.
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

// A second at 30 Hz: shorter pauses count by their duration alone.
constexpr int kFewSteps = 30;

// The number of frames whose error a pause counts as. SLAM's error grows with motion, so a long
// pause of `steps` steps with little `motion` counts as few frames.
inline int MovingStepsIn(int steps, const Pose2& motion, const UsualMotion& usual) {
  // The path is rarely straight. Chosen, not measured; its effect is in docs/tried.md, "Pauses".
  constexpr double kRoundabout = 2.0;
  if (steps <= kFewSteps) return steps;
  return static_cast<int>(std::clamp(std::ceil(kRoundabout * usual.FramesFor(motion)),
                                     double{kFewSteps}, double(steps)));
}

}  // namespace depthgrid
