#include "eval/sweep/sweep_identity.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "eval/output/build_id.h"
#include "eval/sweep/sweep_rooms.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// Whether a value of an axis is a file name, which is relative to the experiment's folder.
bool HasFilesOnAxes(const SweepPlan& plan) {
  const auto& keys = plan.parameter_keys;
  return std::any_of(keys.begin(), keys.end(), IsFileKey);
}

// "" is the current folder, as for a file name without a slash.
std::string AbsoluteFolder(const std::string& folder) {
  return (folder.empty() ? fs::current_path() : fs::absolute(folder)).string();
}

// Whether `line` is one of the lines of `text`.
bool HasLine(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

// Describes the first line in which two texts differ; the line may be missing in one of them.
std::string DifferingLine(const std::string& a, const std::string& b) {
  std::istringstream lines_a(a);
  std::istringstream lines_b(b);
  std::string line_a;
  std::string line_b;
  while (true) {
    const bool more_a = static_cast<bool>(std::getline(lines_a, line_a));
    const bool more_b = static_cast<bool>(std::getline(lines_b, line_b));
    if (!more_a && !more_b) return "";
    if (!more_a) line_a.clear();
    if (!more_b) line_b.clear();
    if (line_a == line_b) continue;
    const std::string here = HasLine(a, line_b) ? "" : line_b;
    const std::string there = HasLine(b, line_a) ? "" : line_a;
    return fmt::format("'{}' there, '{}' here", there, here);
  }
}

}  // namespace

const std::vector<std::string>& WhatMakesASweep() {
  static const std::vector<std::string> kRespects = {"version", "instruction_set", "experiment",
                                                     "given",   "sweep",           "rooms"};
  return kRespects;
}

SweepEnvironment EnvironmentOf(const SweepPlan& plan, const Shard& shard) {
  SweepEnvironment environment = {{"title", plan.title},       {"sweep", plan.sweep_text},
                                  {"again", plan.again_text},  {"experiment", plan.experiment_yaml},
                                  {"given", plan.given_text},  {"version", DEPTHGRID_VERSION},
                                  {"build", BuildId()},        {"instruction_set", DEPTHGRID_ARCH},
                                  {"shard", ShardText(shard)}, {"rooms", RoomsText(plan)}};
  environment["scene_names"] = SceneNamesText(plan);
  if (HasFilesOnAxes(plan)) environment["files_from"] = AbsoluteFolder(plan.base_folder);
  return environment;
}

void RequireSameSweep(const std::string& place, const SweepEnvironment& there,
                      const SweepEnvironment& here, const std::vector<std::string>& respects,
                      const std::string& remedy) {
  for (const std::string& respect : respects) {
    const auto there_is = there.find(respect), here_is = here.find(respect);
    // Written by an earlier version.
    if (there_is == there.end() || here_is == here.end()) continue;
    if (there_is->second == here_is->second) continue;
    const std::string what = respect == "sweep"        ? "another sweep"
                             : respect == "experiment" ? "a sweep of another experiment"
                             : respect == "given"      ? "a sweep with other keys given"
                             : respect == "rooms"
                                 ? "runs in a scene, path or movers that have changed"
                                 : "a sweep of another " + respect;
    throw InputError(place, fmt::format("holds {}: {}; {}", what,
                                        DifferingLine(there_is->second, here_is->second), remedy));
  }
}

std::string ListIn(const SweepEnvironment& environment, const std::string& key) {
  const auto found = environment.find(key);
  return found != environment.end() ? found->second : "unknown";
}

std::string JoinedLists(std::string entries, const std::string& more) {
  std::istringstream list(more);
  for (std::string entry; std::getline(list >> std::ws, entry, ',');) {
    if ((" " + entries + ",").find(" " + entry + ",") == std::string::npos) entries += ", " + entry;
  }
  return entries;
}

}  // namespace depthgrid
