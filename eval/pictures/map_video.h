// A video of the map growing: the scans at their final poses one after the other, and the path. A
// finished map that the run went on in is there from the beginning.
#pragma once

#include <string>

#include "eval/run/mapping_run.h"
#include "mapper/grid/grid_options.h"

namespace depthgrid {

// Throws InputError before anything else when RequireVideo does.
void WriteMapVideo(const std::string& path, const MappingRun& run, const GridOptions& options);

}  // namespace depthgrid
