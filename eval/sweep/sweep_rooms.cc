#include "eval/sweep/sweep_rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <sstream>

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

// The runs in each room, in the order of its first one.
std::vector<std::vector<const PlannedRun*>> RunsByRoom(const SweepPlan& plan) {
  std::vector<std::size_t> naming;  // positions of the keys that choose room, path and movers
  for (std::size_t i = 0; i < plan.parameter_keys.size(); ++i) {
    const std::string& key = plan.parameter_keys[i];
    if (IsFileKey(key) || key == "movers") naming.push_back(i);
  }
  std::map<std::vector<std::string>, std::size_t> seen;
  std::vector<std::vector<const PlannedRun*>> rooms;
  for (const PlannedRun& run : plan.runs) {
    std::vector<std::string> names;
    for (const std::size_t i : naming) names.push_back(run.values[i]);
    const auto [room, is_new] = seen.try_emplace(std::move(names), rooms.size());
    if (is_new) rooms.emplace_back();
    rooms[room->second].push_back(&run);
  }
  return rooms;
}

// The options of the first run in each room.
std::vector<ExperimentOptions> RoomsOf(const SweepPlan& plan) {
  std::vector<ExperimentOptions> rooms;
  for (const auto& runs : RunsByRoom(plan)) rooms.push_back(plan.OptionsOf(*runs.front()));
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
    std::string line = fmt::format("{}{}{}{}: {}", scene, options.trajectory.empty() ? "" : ", ",
                                   std::filesystem::path(options.trajectory).filename().string(),
                                   options.movers == kNoMovers ? "" : ", movers " + options.movers,
                                   HashOrNone(options));
    std::replace(line.begin(), line.end(), '\n', ' ');  // a file's name may have one
    text += line + "\n";
  }
  return text;
}

std::vector<std::string> LinesOfRooms(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<SweptRoom> RoomsIn(const std::string& text, const SweepPlan& plan) {
  const std::vector<std::string> lines = LinesOfRooms(text);
  const auto runs_by_room = RunsByRoom(plan);
  Require(lines.size() == runs_by_room.size(), "each room of a sweep has a line");
  std::vector<SweptRoom> rooms;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    rooms.push_back({lines[i], lines[i].substr(0, lines[i].rfind(':')), {}});
    for (const PlannedRun* run : runs_by_room[i]) rooms.back().runs.push_back(run->run);
  }
  return rooms;
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
