// The video of a command's map (`--video`).
#pragma once

#include <string>
#include <vector>

#include "eval/cli/commands.h"
#include "eval/run/mapping_run.h"
#include "mapper/grid/grid_options.h"

namespace depthgrid::cli {

// That the video can be written, and is none of the command's inputs, before the work.
void RequireVideoFile(const OutputArguments& output, const CommonArguments& common,
                      const std::vector<std::string>& inputs);

// Writes the video, if one is wanted, of a map whose folder is in place already: hours of mapping
// are not lost to an ffmpeg that fails. Throws std::runtime_error, which says where the map is.
void WriteVideo(const OutputArguments& output, const CommonArguments& common, const MappingRun& run,
                const GridOptions& grid);

}  // namespace depthgrid::cli
