// Whether a run mapped the floor as walls because it is higher, in the poses' world, than
// configured.
#pragma once

#include "eval/run/mapping_run.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

// Whether some frames were mapped with the floor at floor_z_m although it is at `seen_z_m` in the
// poses' world, so much higher that it is in the obstacle band. FloorTracker finds a lower floor
// within a few frames, and also one that the first images show close enough.
bool MapsFloor(const MappingRun& run, double seen_z_m, const ScanOptions& options);

}  // namespace depthgrid
