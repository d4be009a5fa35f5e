#include "eval/prior_run.h"

#include <filesystem>

#include "eval/run_files.h"
#include "mapper/core/error.h"
#include "mapper/io/scan_file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

}  // namespace

PriorMap ReadPriorRun(const std::string& folder) {
  const fs::path drawn_path = fs::path(folder) / "scans.bin";
  const fs::path matched_path = fs::path(folder) / "matched.bin";
  RequireRunFolder(folder);
  const std::vector<StoredScan> drawn = ReadScans(drawn_path.string());
  const std::vector<StoredScan> matched =
      fs::exists(matched_path) ? ReadScans(matched_path.string()) : drawn;
  if (drawn.empty()) throw InputError(drawn_path.string(), "holds no scan");
  if (matched.size() != drawn.size()) {
    throw InputError(matched_path.string(), "does not belong to scans.bin");
  }
  PriorMap prior;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    MappedFrame frame;
    frame.frame = static_cast<int>(i) - static_cast<int>(drawn.size());
    frame.stamp_s = drawn[i].stamp_s;
    frame.obstacles = drawn[i].scan;
    frame.scan = matched[i].scan;
    frame.map_from_base = drawn[i].map_from_base;
    prior.frames.push_back(std::move(frame));
  }
  return prior;
}

}  // namespace depthgrid
