#include "eval/record_check.h"

#include <fmt/format.h>

#include "eval/shipped.h"
#include "eval/world.h"

namespace depthgrid {

std::vector<std::string> DoubtsOfRecord(const std::string& path, const Config& record,
                                        const ExperimentOptions& options, const ChosenAnew& anew) {
  if (anew.scene || !record.Has("scene_hash")) return {};
  const WorldHashes now = HashesOf(options);
  std::vector<std::string> doubts;
  const auto compare = [&](const std::string& key, const std::string& hash,
                           const std::string& what) {
    const std::string recorded = record.Text(key, hash);
    if (recorded == hash) return;
    doubts.push_back(fmt::format("{}: {} is {}, but that of {} is {} now: this run is another one",
                                 path, key, recorded, what, hash));
  };
  compare("scene_hash", now.scene, options.scene);
  if (anew.trajectory) return doubts;
  compare("trajectory_hash", now.trajectory,
          IsFileName(options.trajectory) ? options.trajectory : "the path in " + options.scene);
  return doubts;
}

}  // namespace depthgrid
