// Whether a run took the floor for walls, since the poses have it higher than where it was looked
// for.
#pragma once

#include "eval/run/mapping_run.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

// The floor lies at `seen_z_m` of the poses' world, and some frames were mapped as if it lay at
// floor_z_m, so much lower that it is in the obstacle band. A floor that is lower than taken is
// found within a few frames, and so is one that the first images show near enough (FloorTracker).
bool MapsFloor(const MappingRun& run, double seen_z_m, const ScanOptions& options);

}  // namespace depthgrid
