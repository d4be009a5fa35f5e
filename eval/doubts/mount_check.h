// Whether the poses given for a laser are the laser's own.
#pragma once

#include <optional>

#include "eval/run/mapping_run.h"

namespace depthgrid {

// The laser's pose in the axes of the poses given for it, from comparing SLAM's path with that of
// the scans. Given only if it is rotated by 10 degrees or 0.1 m away, and the misfit of the paths
// is less than half as large with it. A position is estimated only if the path includes half a
// turn. Empty for short paths, and where the two differ in scale. Mirrored scans (WayDoubt) and
// scans with wrong angles (TurnScaleDoubt) may look the same.
std::optional<Pose2> MountDoubt(const MappingRun& run);

}  // namespace depthgrid
