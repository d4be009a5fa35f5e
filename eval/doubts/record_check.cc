#include "eval/doubts/record_check.h"

#include <fmt/format.h>

#include "eval/experiment/shipped.h"
#include "eval/run/world.h"

namespace depthgrid {

std::vector<std::string> DoubtsOfRecord(const std::string& path, const Config& record,
                                        const ExperimentOptions& options, const ChosenAnew& anew) {
  const bool is_file = IsFileName(options.trajectory);
  const bool is_same_path = !anew.trajectory && (is_file || !anew.scene);
  if (!record.Has("scene_hash") || (anew.scene && !is_same_path)) return {};
  // A room that is selected again need not be read, and may be unreadable.
  const WorldHashes now =
      anew.scene ? WorldHashes{"", "", HashOfPathFile(options)} : HashesOf(options);
  std::vector<std::string> doubts;
  const auto compare = [&](const std::string& key, const std::string& hash,
                           const std::string& what) {
    const std::string recorded = record.Text(key, hash);
    if (recorded == hash) return;
    doubts.push_back(fmt::format(
        "{}: {} is {}, but that of {} is {} now: this run differs from the recorded one", path, key,
        recorded, what, hash));
  };
  if (!anew.scene) compare("scene_hash", now.scene, options.scene);
  if (is_same_path) {
    compare("trajectory_hash", now.trajectory,
            is_file ? options.trajectory : "the path in " + options.scene);
  }
  return doubts;
}

}  // namespace depthgrid
