// Frames come in even steps of time, but for pauses.
#pragma once

#include <algorithm>
#include <cmath>

namespace depthgrid {

// How many usual steps a step took: more than one where frames did not come. A recording that
// paused for longer than a thousand errs by no more.
inline int StepsIn(double step_s, double usual_s) {
  constexpr double kMostSteps = 1000.0;
  if (!(usual_s > 0.0) || !(step_s > usual_s)) return 1;
  return static_cast<int>(std::min(std::round(step_s / usual_s), kMostSteps));
}

}  // namespace depthgrid
