// The map that SLAM's poses alone make of a run's scans: what mapping has to better.
#pragma once

#include "eval/run/mapping_run.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/grid/grid_options.h"

namespace depthgrid {

// Drawn at SLAM's live poses: the input, as a map.
OccupancyMap InputPoseMap(const MappingRun& run, const GridOptions& options);

}  // namespace depthgrid
