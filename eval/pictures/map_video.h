// A video of the map growing: the scans at their final poses one after the other, and the path. A
// prior map is shown from the beginning.
#pragma once

#include <string>

#include "eval/run/mapping_run.h"
#include "mapper/grid/grid_options.h"

namespace depthgrid {

// First throws InputError as RequireVideo does.
void WriteMapVideo(const std::string& path, const MappingRun& run, const GridOptions& options);

}  // namespace depthgrid
