// Draws the map of a finished run.
#pragma once

#include <vector>

#include "mapper/core/mapped_frame.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/grid/grid_options.h"

namespace depthgrid {

// A MapDrawing of the kept frames' scans as they are.
OccupancyMap DrawKept(const std::vector<MappedFrame>& frames, const GridOptions& options);

// Whether a laser's noise spreads its hits beyond their cells, so that DrawFinished() sharpens
// them.
bool IsSharpened(const std::vector<MappedFrame>& frames, const GridOptions& options);

// A MapDrawing of the kept frames, in which a laser's noisy hits lie on the walls that all scans
// together show (GridOptions::sharpen_sigmas; docs/math.md, "The finished map").
OccupancyMap DrawFinished(const std::vector<MappedFrame>& frames, const GridOptions& options);

}  // namespace depthgrid
