// Whether the stamps of two trajectories are of clocks that differ, told from where they were when.
#pragma once

#include <optional>

#include "mapper/core/trajectory.h"

namespace depthgrid {

// What `map` looks for too (mapper/io/pose_check.cc).
constexpr double kMostClockOffsetS = 5.0;

struct ClockOffset {
  double offset_s = 0.0;         // to be added to the estimate's stamps
  double unsure_s = 0.0;         // so much more or less fits alike
  double misfit_m = 0.0;         // root mean square, aligned, with the stamps as they are
  double better_misfit_m = 0.0;  // and with the offset; the same poses both times
};

// The offset with which positions fit at less than 0.7 times the misfit (drift alone comes to 0.8
// and more on recorded and simulated runs). Empty where there is none, as for a straight line at
// one speed, which fits with any.
std::optional<ClockOffset> FindClockOffset(const Trajectory& reference, const Trajectory& estimate);

}  // namespace depthgrid
