#include "eval/sweep/sweep_rooms.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "eval/world.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

std::string HashOrNone(const ExperimentOptions& options) {
  try {
    return WorldHash(options);
  } catch (const InputError&) {
    return "none";  // its runs fail and say why
  }
}

}  // namespace

std::string RoomsText(const SweepPlan& plan) {
  std::vector<std::size_t> naming;  // positions of the keys that choose room and path
  for (std::size_t i = 0; i < plan.parameter_keys.size(); ++i) {
    if (IsFileKey(plan.parameter_keys[i])) naming.push_back(i);
  }
  std::set<std::vector<std::string>> seen;
  std::string text;
  for (const PlannedRun& run : plan.runs) {
    std::vector<std::string> names;
    for (const std::size_t i : naming) names.push_back(run.values[i]);
    if (!seen.insert(std::move(names)).second) continue;
    const ExperimentOptions options = plan.OptionsOf(run);
    const std::string scene = std::filesystem::path(options.scene).filename().string();
    text += fmt::format("{}{}{}: {}\n", scene, options.trajectory.empty() ? "" : ", ",
                        std::filesystem::path(options.trajectory).filename().string(),
                        HashOrNone(options));
  }
  return text;
}

}  // namespace depthgrid
