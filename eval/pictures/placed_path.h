// SLAM's poses shown in a finished map that a run went on in.
#pragma once

#include "mapper/core/trajectory.h"

namespace depthgrid {

// SLAM's frame lies anywhere in that map: its poses are laid where the estimate has the first of
// those that both know, by one planar motion. With no such pose they stay as they are.
Trajectory PlacedWhereItBegins(Trajectory slam, const Trajectory& estimate);

}  // namespace depthgrid
