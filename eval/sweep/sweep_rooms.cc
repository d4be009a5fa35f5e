#include "eval/sweep/sweep_rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "eval/doubts/truth_check.h"
#include "eval/experiment/shipped.h"
#include "eval/run/world.h"
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

// The options of the first run in each room.
std::vector<ExperimentOptions> RoomsOf(const SweepPlan& plan) {
  std::vector<std::size_t> naming;  // positions of the keys that choose room, path and movers
  for (std::size_t i = 0; i < plan.parameter_keys.size(); ++i) {
    const std::string& key = plan.parameter_keys[i];
    if (IsFileKey(key) || key == "movers") naming.push_back(i);
  }
  std::set<std::vector<std::string>> seen;
  std::vector<ExperimentOptions> rooms;
  for (const PlannedRun& run : plan.runs) {
    std::vector<std::string> names;
    for (const std::size_t i : naming) names.push_back(run.values[i]);
    if (seen.insert(std::move(names)).second) rooms.push_back(plan.OptionsOf(run));
  }
  return rooms;
}

// The error that a check of a room's names throws; empty if there is none.
std::string FailureOf(const SweepPlan& plan, const std::function<void()>& check) {
  try {
    NamingPlaces(plan.PlaceOfKey(), check);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// A scene, path or movers, with the error in it; empty if it can be used.
struct NamedPart {
  std::string name;
  std::string failure;
};

// Each is judged by itself: a path that the scene lacks says nothing about scene and movers.
std::vector<NamedPart> NamedPartsOf(const SweepPlan& plan, const ExperimentOptions& options) {
  ExperimentOptions empty = options;
  empty.movers = kNoMovers;
  const std::string scene = FailureOf(plan, [&] { RequireMovers(empty); });
  std::vector<NamedPart> parts = {{"scene " + options.scene, scene}};
  if (!scene.empty()) return parts;
  parts.push_back({"trajectory " + options.trajectory,  //
                   FailureOf(plan, [&] { RequireNames(empty); })});
  parts.push_back({"movers " + options.movers, FailureOf(plan, [&] { RequireMovers(options); })});
  return parts;
}

}  // namespace

void RequireRooms(const SweepPlan& plan) {
  std::set<std::string> usable;
  std::vector<NamedPart> failed;
  for (const ExperimentOptions& options : RoomsOf(plan)) {
    for (const NamedPart& part : NamedPartsOf(plan, options)) {
      if (part.failure.empty()) {
        usable.insert(part.name);
      } else {
        failed.push_back(part);
      }
    }
  }
  for (const NamedPart& part : failed) {
    if (!usable.contains(part.name)) throw InputError("", part.failure);
  }
}

std::string RoomsText(const SweepPlan& plan) {
  std::string text;
  for (const ExperimentOptions& options : RoomsOf(plan)) {
    const std::string scene = std::filesystem::path(options.scene).filename().string();
    text += fmt::format("{}{}{}{}: {}\n", scene, options.trajectory.empty() ? "" : ", ",
                        std::filesystem::path(options.trajectory).filename().string(),
                        options.movers == kNoMovers ? "" : ", movers " + options.movers,
                        HashOrNone(options));
  }
  return text;
}

std::string SceneNamesText(const SweepPlan& plan) {
  const auto& keys = plan.parameter_keys;
  const auto axis = std::find(keys.begin(), keys.end(), "scene");
  std::map<std::string, std::string> names;
  for (const PlannedRun& run : plan.runs) {
    if (axis == keys.end() && !names.empty()) break;
    std::string value;
    if (axis != keys.end()) value = run.values[static_cast<std::size_t>(axis - keys.begin())];
    if (names.contains(value)) continue;
    try {
      const std::string scene = plan.OptionsOf(run).scene;
      names[value] = LoadNamedScene(scene).name;
      if (axis == keys.end()) return fmt::format("{} = {}\n", scene, names[value]);
    } catch (const InputError&) {  // its runs fail and say why
      names[value] = "";
    }
  }
  std::string text;
  for (const auto& [value, name] : names) {
    if (!name.empty()) text += fmt::format("{} = {}\n", value, name);
  }
  return text;
}

std::vector<std::string> DoubtsOfPaths(const SweepPlan& plan, int threads) {
  std::vector<std::string> doubts;
  const auto add = [&](const std::string& doubt) {
    const bool is_new = std::find(doubts.begin(), doubts.end(), doubt) == doubts.end();
    if (is_new) doubts.push_back(doubt);
  };
  for (const ExperimentOptions& options : RoomsOf(plan)) {
    try {
      const World world = LoadWorld(options, threads);
      for (const std::string& doubt : world.path_doubts) add(doubt);
      if (const auto doubt = DoubtOfStorey(world, options)) add(*doubt);
    } catch (const InputError&) {  // its runs fail and say why
    }
  }
  return doubts;
}

}  // namespace depthgrid
