#include "eval/sweep/sweep_rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

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

// The error in the names of a room's runs; empty if there is none.
std::string FailureOf(const SweepPlan& plan, const ExperimentOptions& options) {
  try {
    NamingPlaces(plan.PlaceOfKey(), [&] { RequireNames(options); });
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::vector<std::string> NamesIn(const ExperimentOptions& options) {
  return {"scene " + options.scene, "trajectory " + options.trajectory, "movers " + options.movers};
}

}  // namespace

void RequireRooms(const SweepPlan& plan) {
  std::set<std::string> usable;
  std::vector<std::pair<std::string, ExperimentOptions>> failed;
  for (const ExperimentOptions& options : RoomsOf(plan)) {
    const std::string failure = FailureOf(plan, options);
    if (!failure.empty()) {
      failed.emplace_back(failure, options);
      continue;
    }
    for (const std::string& name : NamesIn(options)) usable.insert(name);
  }
  for (const auto& [failure, options] : failed) {
    for (const std::string& name : NamesIn(options)) {
      if (!usable.contains(name)) throw InputError("", failure);
    }
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
