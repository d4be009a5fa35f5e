// The video of a command's map (`--video`).
#pragma once

#include <string>
#include <vector>

#include "eval/cli/commands.h"
#include "eval/run/mapping_run.h"
#include "mapper/grid/grid_options.h"

namespace depthgrid::cli {

// Checks, before the work, that the video can be written and is not one of the command's inputs.
void RequireVideoFile(const OutputArguments& output, const CommonArguments& common,
                      const std::vector<std::string>& inputs);

// Writes the video, if requested, after the map's folder is complete, so that a failure of ffmpeg
// does not lose hours of mapping. Throws std::runtime_error, which says where the map is.
void WriteVideo(const OutputArguments& output, const CommonArguments& common, const MappingRun& run,
                const GridOptions& grid);

}  // namespace depthgrid::cli
