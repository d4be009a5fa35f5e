#include "eval/compare/comparison_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>

#include "eval/compare/fixed_settings.h"
#include "eval/sweep/sweep_axes.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

using Key = std::vector<std::string>;

// 0.5 and 0.50 are the same value; seeds too large for a double remain distinct.
std::string ValueAt(const SweepParameter& parameter, std::size_t row) {
  return ShortestYaml(parameter.texts[row]);
}

// Axes of both sides that no condition fixes.
std::vector<std::string> SharedAxes(const SweepResults& a, const SweepResults& b,
                                    const CompareOptions& options) {
  std::vector<std::string> keys;
  for (const SweepParameter& parameter : a.parameters) {
    const std::string& key = parameter.key;
    const bool is_fixed = NamesKey(options.where_a, key) || NamesKey(options.where_b, key);
    if (b.HasParameter(key) && !is_fixed) keys.push_back(key);
  }
  return keys;
}

// A value as a sweep stores it: "[1, 1, 0]" for "[1,1,0]".
std::string AsOnAxis(const std::string& value) {
  if (!value.starts_with("[")) return ShortestYaml(value);
  Config config;
  config.Set("value", value, "--where");
  return config.Entries().front().text;
}

// Lists the first distinct values, and the number of others.
std::string SomeValues(const SweepParameter& parameter, const std::vector<std::size_t>& rows) {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> values;
  for (const std::size_t row : rows) {
    const std::string value = ValueAt(parameter, row);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  const std::size_t more = values.size() > kMost ? values.size() - kMost : 0;
  values.resize(values.size() - more);
  const std::string list = fmt::format("{}", fmt::join(values, ", "));
  return more > 0 ? fmt::format("{} and {} more", list, more) : list;
}

std::vector<std::size_t> RowsThatMeet(const SweepResults& table,
                                      const std::vector<Condition>& where) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.failures[row].empty()) rows.push_back(row);
  }
  for (const auto& [key, value] : where) {
    const SweepParameter& parameter = table.Parameter(key);
    if (rows.empty()) throw InputError(table.folder, "no run has a result");
    const std::string wanted = AsOnAxis(value);
    const std::vector<std::size_t> candidates = rows;
    std::erase_if(rows, [&](std::size_t row) { return ValueAt(parameter, row) != wanted; });
    if (rows.empty()) {
      throw InputError(table.folder, fmt::format("no run has {} = {}, there are {}", key, value,
                                                 SomeValues(parameter, candidates)));
    }
  }
  return rows;
}

// The first axis in which two rows differ, or "".
std::string WhatDiffers(const SweepResults& table, std::size_t row, std::size_t other) {
  for (const SweepParameter& parameter : table.parameters) {
    if (ValueAt(parameter, row) != ValueAt(parameter, other)) return parameter.key;
  }
  return "";
}

// The value common to all of the rows, or "".
std::string OnlyValue(const SweepResults& table, const std::string& key,
                      const std::vector<std::size_t>& rows) {
  const SweepParameter& parameter = table.Parameter(key);
  const std::string first = rows.empty() ? "" : ValueAt(parameter, rows.front());
  const bool is_only = std::all_of(
      rows.begin(), rows.end(), [&](std::size_t row) { return ValueAt(parameter, row) == first; });
  return is_only ? first : "";
}

// Removes from `keys` the settings that have a single value on each side, but different ones, as do
// keys that change together with one in a condition.
std::vector<DifferentSetting> TakeDifferent(const SweepResults& a,
                                            const std::vector<std::size_t>& rows_a,
                                            const SweepResults& b,
                                            const std::vector<std::size_t>& rows_b,
                                            std::vector<std::string>& keys) {
  std::vector<DifferentSetting> different;
  std::erase_if(keys, [&](const std::string& key) {
    if (MakesPairs(key)) return false;
    const std::string in_a = OnlyValue(a, key, rows_a);
    const std::string in_b = OnlyValue(b, key, rows_b);
    if (in_a.empty() || in_b.empty() || in_a == in_b) return false;
    different.push_back({key, in_a, in_b});
    return true;
  });
  return different;
}

// A side's settings that are fixed, also by being the same in all of the chosen rows.
FixedSettings FixedIn(const SweepResults& table, const std::vector<std::size_t>& rows) {
  FixedSettings fixed = FixedSettingsOf(table);
  for (const SweepParameter& parameter : table.parameters) {
    const std::string value = OnlyValue(table, parameter.key, rows);
    if (!value.empty()) fixed.values.emplace_back(parameter.key, value);
  }
  return fixed;
}

// Adds the settings in which the sides differ without their being axes of both.
void AddFixedDifferences(const SweepResults& a, const std::vector<std::size_t>& rows_a,
                         const SweepResults& b, const std::vector<std::size_t>& rows_b,
                         const CompareOptions& options, std::vector<DifferentSetting>& different) {
  for (DifferentSetting& setting : FixedDifferences(FixedIn(a, rows_a), FixedIn(b, rows_b))) {
    const std::string& key = setting.key;
    const bool by_condition = NamesKey(options.where_a, key) && NamesKey(options.where_b, key);
    if (by_condition || (a.HasParameter(key) && b.HasParameter(key))) continue;
    different.push_back(std::move(setting));
  }
}

std::string NameOfRun(const SweepResults& table, std::size_t row) {
  return table.run_folders.empty() ? fmt::format("run {}", table.runs[row])
                                   : table.run_folders[row];
}

// The error for two runs that nothing in the table distinguishes, such as the cases of a study.
std::string SamePairText(const SweepResults& table, std::size_t first, std::size_t second,
                         const std::vector<std::string>& shared) {
  std::vector<std::string> same;
  for (const std::string& axis : shared) {
    const std::string value = ValueAt(table.Parameter(axis), first);
    if (!value.empty()) same.push_back(fmt::format("{} = {}", axis, value));
  }
  return fmt::format(
      "holds several runs that make the same pair: {} and {} ({}); compare folders of one run "
      "each, or folders whose runs differ in these",
      NameOfRun(table, first), NameOfRun(table, second), fmt::join(same, ", "));
}

std::map<Key, std::size_t> RowsByKey(const SweepResults& table,
                                     const std::vector<std::size_t>& rows,
                                     const std::vector<std::string>& shared) {
  std::map<Key, std::size_t> by_key;
  for (const std::size_t row : rows) {
    Key key;
    for (const std::string& axis : shared) key.push_back(ValueAt(table.Parameter(axis), row));
    const auto [found, is_new] = by_key.emplace(key, row);
    if (is_new) continue;
    const std::string differs = WhatDiffers(table, row, found->second);
    throw InputError(table.folder,
                     differs.empty()
                         ? SamePairText(table, found->second, row, shared)
                         : fmt::format("its runs differ in {}, which the other side does not have: "
                                       "choose with --where-a or --where-b {}=VALUE",
                                       differs, differs));
  }
  return by_key;
}

struct Pair {
  std::size_t a;
  std::size_t b;
  Key seeds;
  Key rest;  // the other values that it is paired by
};

// Seeds that gave the same as another one in every score of every pair, as where nothing is random:
// together they are one measurement.
std::set<Key> RepeatedSeeds(const SweepResults& a, const SweepResults& b,
                            const std::vector<Pair>& pairs) {
  using Bits = std::vector<std::uint64_t>;
  using Scores = std::map<Key, std::pair<Bits, Bits>>;  // of both sides, by the other values
  std::map<Key, Scores> by_seed;
  for (const Pair& pair : pairs) {
    by_seed[pair.seeds][pair.rest] = {a.ScoreBits(pair.a), b.ScoreBits(pair.b)};
  }
  std::set<Scores> known;
  std::set<Key> repeated;
  for (auto& [seeds, scores] : by_seed) {
    if (!known.insert(std::move(scores)).second) repeated.insert(seeds);
  }
  return repeated;
}

std::vector<std::size_t> SeedAxes(const std::vector<std::string>& paired_by) {
  std::vector<std::size_t> axes;
  for (std::size_t axis = 0; axis < paired_by.size(); ++axis) {
    if (IsSeedKey(paired_by[axis])) axes.push_back(axis);
  }
  return axes;
}

std::vector<Pair> JoinRows(const std::map<Key, std::size_t>& rows_a,
                           const std::map<Key, std::size_t>& rows_b,
                           const std::vector<std::size_t>& seed_axes) {
  std::vector<Pair> pairs;
  for (const auto& [key, row] : rows_a) {
    const auto other = rows_b.find(key);
    if (other == rows_b.end()) continue;
    Pair pair{row, other->second, {}, {}};
    for (std::size_t axis = 0; axis < key.size(); ++axis) {
      const bool is_seed = std::find(seed_axes.begin(), seed_axes.end(), axis) != seed_axes.end();
      (is_seed ? pair.seeds : pair.rest).push_back(key[axis]);
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace

RunPairs PairsOf(const SweepResults& a, const SweepResults& b, const CompareOptions& options) {
  RunPairs pairs;
  Pairing& pairing = pairs.pairing;
  const std::vector<std::size_t> chosen_a = RowsThatMeet(a, options.where_a);
  const std::vector<std::size_t> chosen_b = RowsThatMeet(b, options.where_b);
  pairing.paired_by = SharedAxes(a, b, options);
  pairing.different = TakeDifferent(a, chosen_a, b, chosen_b, pairing.paired_by);
  AddFixedDifferences(a, chosen_a, b, chosen_b, options, pairing.different);
  const auto rows_a = RowsByKey(a, chosen_a, pairing.paired_by);
  const auto rows_b = RowsByKey(b, chosen_b, pairing.paired_by);
  const std::vector<std::size_t> seed_axes = SeedAxes(pairing.paired_by);
  std::vector<Pair> found = JoinRows(rows_a, rows_b, seed_axes);
  pairing.runs_a = static_cast<int>(rows_a.size());
  pairing.runs_b = static_cast<int>(rows_b.size());
  pairing.unpaired_a = static_cast<int>(rows_a.size() - found.size());
  pairing.unpaired_b = static_cast<int>(rows_b.size() - found.size());
  const std::set<Key> repeated = RepeatedSeeds(a, b, found);
  pairing.repeated_seeds = static_cast<int>(repeated.size());
  std::erase_if(found, [&](const Pair& pair) { return repeated.contains(pair.seeds); });
  std::vector<Key> seeds;
  for (Pair& pair : found) {
    pairs.a.push_back(pair.a);
    pairs.b.push_back(pair.b);
    seeds.push_back(std::move(pair.seeds));
  }
  pairs.units = SeedUnits(seeds);
  for (const std::size_t axis : pairs.units.crossed()) {
    pairing.crossed_seeds.push_back(pairing.paired_by[seed_axes[axis]]);
  }
  pairing.pairs = static_cast<int>(pairs.a.size());
  pairing.units = static_cast<int>(pairs.units.count());
  if (pairs.a.empty()) {
    throw InputError(b.folder, fmt::format("shares no run with {} (by {}): choose what differs on "
                                           "purpose with --where-a KEY=VALUE and --where-b",
                                           a.folder, fmt::join(pairing.paired_by, ", ")));
  }
  return pairs;
}

}  // namespace depthgrid
