// Frames come in even steps of time, but for pauses.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "mapper/core/median.h"

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

}  // namespace depthgrid
