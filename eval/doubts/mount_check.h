// Whether the poses given for a laser are the laser's own.
#pragma once

#include <optional>

#include "eval/run/mapping_run.h"

namespace depthgrid {

// Where the laser is in the axes of the poses given for it, as far as the two ways say: turned by
// 10 degrees or 0.1 m away, and the ways fit so at less than half the misfit. A position is told
// only of way with half a turn in it. Nothing for short ways, and where the two differ in scale.
// Mirrored scans (WayDoubt) and scans of wrong angles (TurnScaleDoubt) may look like that.
std::optional<Pose2> MountDoubt(const MappingRun& run);

}  // namespace depthgrid
