// SLAM's poses for display in a prior map.
#pragma once

#include "mapper/core/trajectory.h"

namespace depthgrid {

// SLAM's frame is arbitrary relative to that map. Moves its poses by one planar motion so that the
// first pose that both have coincides with the estimate's. Without such a pose they are unchanged.
Trajectory PlacedWhereItBegins(Trajectory slam, const Trajectory& estimate);

}  // namespace depthgrid
