// Whether the stamps of two trajectories are from different clocks, judged by the positions.
#pragma once

#include <optional>

#include "mapper/core/trajectory.h"

namespace depthgrid {

// The same as in `map` (mapper/io/pose_check.cc).
constexpr double kMostClockOffsetS = 5.0;

struct ClockOffset {
  double offset_s = 0.0;         // to be added to the estimate's stamps
  double unsure_s = 0.0;         // offsets within +- this fit equally well
  double misfit_m = 0.0;         // root mean square, aligned, with the stamps as they are
  double better_misfit_m = 0.0;  // with the offset; over the same poses
};

// The offset with which the misfit is less than 0.7 times that without (on recorded and simulated
// runs fitting drift alone gave 0.8 or more), and with which twelve stretches, each aligned by
// itself, fit better as well: an estimate that is bent may as a whole fit better with an offset,
// but its stretches do not (docs/tried.md, "Late or bent"). Empty where there is none, as for a
// straight line at constant speed, which fits with any offset.
std::optional<ClockOffset> FindClockOffset(const Trajectory& reference, const Trajectory& estimate);

}  // namespace depthgrid
