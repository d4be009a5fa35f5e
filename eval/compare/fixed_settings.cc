#include "eval/compare/fixed_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

#include "eval/files/run_files.h"
#include "eval/sweep/sweep_axes.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

const std::vector<std::string>& PairingKeys() {
  static const std::vector<std::string> keys = {"scene",     "trajectory",     "movers",
                                                "frames",    "seed",           "depth_seed",
                                                "slam_seed", "trajectory_seed"};
  return keys;
}

bool IsOfTheRoom(const std::string& key) {
  return key == "scene" || key == "trajectory" || key == "movers";
}

FixedSettings OfASweep(const SweepResults& table) {
  FixedSettings fixed;
  const std::string experiment = table.EnvironmentText("experiment");
  if (experiment.empty()) return fixed;
  fixed.values = LeavesOf(Config::FromText(experiment, table.folder));
  const std::string given = table.EnvironmentText("given");
  if (given.empty()) return fixed;
  for (const auto& leaf : LeavesOf(Config::FromText(given, table.folder))) {
    fixed.given.push_back(leaf.first);
  }
  return fixed;
}

FixedSettings OfRuns(const SweepResults& table) {
  FixedSettings fixed;
  for (std::size_t i = 0; i < table.run_folders.size(); ++i) {
    const auto leaves = LeavesOf(Config::FromFile(table.run_folders[i] + "/run.yaml"));
    if (i == 0) {
      fixed.values = leaves;
      continue;
    }
    const std::map<std::string, std::string> others(leaves.begin(), leaves.end());
    std::erase_if(fixed.values, [&](const auto& leaf) {
      const auto other = others.find(leaf.first);
      return other == others.end() || other->second != leaf.second;
    });
  }
  return fixed;
}

// Hashes of the sweep's rooms with their paths, by name.
std::map<std::string, std::string> RoomHashes(const SweepResults& table) {
  std::map<std::string, std::string> hashes;
  std::istringstream lines(table.EnvironmentText("rooms"));
  for (std::string line; std::getline(lines, line);) {
    const auto colon = line.rfind(": ");
    if (colon != std::string::npos) hashes[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return hashes;
}

// Whether each has a single room and path, with the same content. The names may differ, as where
// the path is the scene's first or is named.
bool ShareTheOnlyRoom(const std::map<std::string, std::string>& a,
                      const std::map<std::string, std::string>& b) {
  return a.size() == 1 && b.size() == 1 && a.begin()->second == b.begin()->second;
}

void AddFixedColumn(const std::string& key, const std::string& value, SweepResults& table) {
  const double number = ParseNumber(value).value_or(std::numeric_limits<double>::quiet_NaN());
  table.parameters.push_back({key, std::vector<std::string>(table.rows(), value),
                              std::vector<double>(table.rows(), number)});
}

void AddConditionsOf(const std::vector<Condition>& where, const FixedSettings& fixed,
                     SweepResults& table) {
  for (const Condition& condition : where) {
    const std::string* value = fixed.Find(condition.first);
    if (value && !table.HasParameter(condition.first))
      AddFixedColumn(condition.first, *value, table);
  }
}

// A scene on an axis may be named relative to another folder than the fixed one.
std::string AsOnThatAxis(const std::string& key, const std::string& value,
                         const SweepResults& other) {
  if (key != "scene") return value;
  const auto name = std::filesystem::path(value).filename();
  for (const std::string& text : other.Parameter(key).texts) {
    if (std::filesystem::path(text).filename() == name) return text;
  }
  return value;
}

void RequireSameValue(const std::string& key, const std::string& in_a, const SweepResults& a,
                      const std::string& in_b, const SweepResults& b) {
  if (ShortestYaml(in_a) == ShortestYaml(in_b)) return;
  throw InputError(
      b.folder,
      fmt::format("{0} is '{1}', in {2} '{3}': runs that differ in it make no pairs; to compare "
                  "them on purpose, say --where-a {0}='{3}' --where-b {0}='{1}'",
                  key, in_b, a.folder, in_a));
}

void RequireSameContents(const std::map<std::string, std::string>& a,
                         const std::map<std::string, std::string>& b, const SweepResults& table_a,
                         const SweepResults& table_b) {
  for (const auto& [name, hash] : b) {
    const auto other = a.find(name);
    if (other == a.end() || other->second == hash) continue;
    throw InputError(table_b.folder,
                     fmt::format("its scene, path or movers of '{}' have other contents than those "
                                 "of {}, must be the same to make pairs",
                                 name, table_a.folder));
  }
}

// Settings that only follow from others, or say who did the runs.
bool FollowsFromOthers(const std::string& key, const FixedSettings& a, const FixedSettings& b) {
  if (key.starts_with("provenance.") || key == "mapper.scan.floor_z_m") return true;
  const auto is_given = [&](const FixedSettings& side) {
    return std::find(side.given.begin(), side.given.end(), key) != side.given.end();
  };
  if (is_given(a) || is_given(b)) return false;
  const auto has_same = [&](const char* name) {
    const std::string* in_a = a.Find(name);
    const std::string* in_b = b.Find(name);
    return in_a && in_b && *in_a == *in_b;
  };
  if (key.starts_with("slam.") && key != "slam.profile") return !has_same("slam.profile");
  const std::string* source = a.Find("mapper.fusion.slam_noise.source");
  const bool of_profile = source && *source == "profile";
  return of_profile && key.starts_with("mapper.fusion.slam_noise.") && !key.ends_with(".source");
}

}  // namespace

bool MakesPairs(const std::string& key) {
  const auto& keys = PairingKeys();
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

bool NamesKey(const std::vector<Condition>& where, const std::string& key) {
  return std::any_of(where.begin(), where.end(),
                     [&](const Condition& c) { return c.first == key; });
}

const std::string* FixedSettings::Find(const std::string& key) const {
  for (const auto& [name, value] : values) {
    if (name == key) return &value;
  }
  return nullptr;
}

FixedSettings FixedSettingsOf(const SweepResults& table) {
  FixedSettings fixed = table.run_folders.empty() ? OfASweep(table) : OfRuns(table);
  std::erase_if(fixed.values, [&](const auto& leaf) { return table.HasParameter(leaf.first); });
  return fixed;
}

void AlignFixedSettings(const CompareOptions& options, SweepResults& a, SweepResults& b) {
  const FixedSettings fixed_a = FixedSettingsOf(a);
  const FixedSettings fixed_b = FixedSettingsOf(b);
  AddConditionsOf(options.where_a, fixed_a, a);
  AddConditionsOf(options.where_b, fixed_b, b);
  const auto rooms_a = RoomHashes(a);
  const auto rooms_b = RoomHashes(b);
  const bool one_room = ShareTheOnlyRoom(rooms_a, rooms_b);
  for (const std::string& key : PairingKeys()) {
    if (NamesKey(options.where_a, key) || NamesKey(options.where_b, key)) continue;
    const std::string* in_a = fixed_a.Find(key);
    const std::string* in_b = fixed_b.Find(key);
    if (in_a && in_b && !(one_room && IsOfTheRoom(key))) RequireSameValue(key, *in_a, a, *in_b, b);
    if (IsSeedKey(key)) continue;
    if (in_a && b.HasParameter(key)) AddFixedColumn(key, AsOnThatAxis(key, *in_a, b), a);
    if (in_b && a.HasParameter(key) && !in_a) AddFixedColumn(key, AsOnThatAxis(key, *in_b, a), b);
  }
  RequireSameContents(rooms_a, rooms_b, a, b);
}

std::vector<DifferentSetting> FixedDifferences(const FixedSettings& a, const FixedSettings& b) {
  std::vector<DifferentSetting> different;
  for (const auto& [key, in_a] : a.values) {
    const std::string* in_b = b.Find(key);
    const bool differs = in_b && ShortestYaml(in_a) != ShortestYaml(*in_b);
    if (differs && !MakesPairs(key) && !FollowsFromOthers(key, a, b)) {
      different.push_back({key, in_a, *in_b});
    }
  }
  return different;
}

}  // namespace depthgrid
