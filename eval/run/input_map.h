// The map of a run's scans at SLAM's own poses, as a baseline.
#pragma once

#include "eval/run/mapping_run.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/grid/grid_options.h"

namespace depthgrid {

// Drawn at SLAM's live poses, the mapper's input.
OccupancyMap InputPoseMap(const MappingRun& run, const GridOptions& options);

}  // namespace depthgrid
