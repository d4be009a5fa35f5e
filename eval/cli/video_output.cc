#include "eval/cli/video_output.h"

#include <stdexcept>

#include "eval/kept_inputs.h"
#include "eval/map_video.h"
#include "eval/output_file.h"
#include "eval/video_writer.h"

namespace depthgrid::cli {

void RequireVideoFile(const OutputArguments& output, const CommonArguments& common,
                      const std::vector<std::string>& inputs) {
  if (output.video.empty()) return;
  RequireInputsKept(output.video, "--video", inputs);
  RequireNewFile(output.video, common.force);
  RequireVideo(output.video);
}

void WriteVideo(const OutputArguments& output, const CommonArguments& common, const MappingRun& run,
                const GridOptions& grid) {
  if (output.video.empty()) return;
  try {
    WriteMapVideo(output.video, run, grid);
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string(error.what()) + "; the map is in " + common.output);
  }
}

}  // namespace depthgrid::cli
