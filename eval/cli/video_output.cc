#include "eval/cli/video_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "eval/output/kept_inputs.h"
#include "eval/output/output_file.h"
#include "eval/pictures/map_video.h"
#include "eval/pictures/video_writer.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {

namespace {

namespace fs = std::filesystem;

// Rejects a video path that is the output folder or a parent of it that is yet to be created.
void RequireNoFolderThere(const std::string& video, const std::string& output) {
  std::error_code error;  // errors are reported when the folder is created
  const fs::path folder = fs::weakly_canonical(fs::absolute(output), error);
  const fs::path file = fs::weakly_canonical(fs::absolute(video), error);
  if (error ||
      std::mismatch(file.begin(), file.end(), folder.begin(), folder.end()).first != file.end()) {
    return;
  }
  throw InputError("--video " + video,
                   fmt::format("is where -o {} makes a folder; choose another name", output));
}

}  // namespace

void RequireVideoFile(const OutputArguments& output, const CommonArguments& common,
                      const std::vector<std::string>& inputs) {
  if (output.video.empty()) return;
  RequireInputsKept(output.video, "--video", inputs);
  RequireNoFolderThere(output.video, common.output);
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
