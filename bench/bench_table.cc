#include "bench/bench_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "mapper/core/error.h"

namespace depthgrid::bench {
namespace {

// Filled by static initialisers of the benchmark files, so a function-local static.
std::vector<Case>& Cases() {
  static std::vector<Case> cases;
  return cases;
}

struct Floor {
  Loop loop;
  int iterations = 0;
};
std::map<std::string, Floor>& Floors() {
  static std::map<std::string, Floor> floors;
  return floors;
}

void Register(const std::string& name, const Loop& loop, int iterations) {
  auto* benchmark = benchmark::RegisterBenchmark(name.c_str(), loop);
  if (iterations > 0) benchmark->Iterations(iterations);
}

std::string NameOf(const Case& row) { return row.stage + "/" + row.size; }
std::string NameOfFloor(const std::string& floor) { return "floor/" + floor; }

std::optional<double> Find(const Times& times, const std::string& name) {
  const auto found = times.find(name);
  return found == times.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> Find(const Ratios& ratios, const Case& row) {
  const auto stage = ratios.find(row.stage);
  if (stage == ratios.end()) return std::nullopt;
  const auto found = stage->second.find(row.size);
  return found == stage->second.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> RatioOf(const Times& times, const Case& row) {
  const auto time = Find(times, NameOf(row));
  const auto floor = Find(times, NameOfFloor(row.floor));
  if (!time || !floor) return std::nullopt;
  return *time / *floor;
}

std::string TimeText(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (seconds < 1.0) return fmt::format("{:.3g} ms", seconds * 1e3);
  return fmt::format("{:.3g} s", seconds);
}

// Measurements are less accurate than three digits.
double Rounded(double ratio) { return std::stod(fmt::format("{:.3g}", ratio)); }

// The displayed part of a floor's name; the case it belongs to follows '@'.
std::string LabelOf(const std::string& floor) { return floor.substr(0, floor.find(" @")); }

std::string ChangeText(double ratio, const std::optional<double>& before, double band) {
  if (!before) return "new";
  const double change = ratio / *before - 1.0;
  if (change > band) return fmt::format("**{:+.0f} %**", 100.0 * change);
  return fmt::format("{:+.0f} %", 100.0 * change);
}

}  // namespace

void AddFloor(const std::string& name, const Loop& loop, int iterations) {
  Floors().insert({name, {loop, iterations}});
}

// Inserts it after the other cases of its stage.
void AddCase(const Case& row) {
  const auto same_stage = [&](const Case& other) { return other.stage == row.stage; };
  const auto last = std::find_if(Cases().rbegin(), Cases().rend(), same_stage);
  Cases().insert(last == Cases().rend() ? Cases().end() : last.base(), row);
}

void RegisterCases(const std::string& filter, bool with_slow) {
  std::set<std::string> floors;
  bool is_any_slow = false;
  for (const Case& row : Cases()) {
    if (NameOf(row).find(filter) == std::string::npos) continue;
    is_any_slow |= row.slow;
    if (row.slow && !with_slow) continue;
    Register(NameOf(row), row.loop, row.iterations);
    floors.insert(row.floor);
  }
  if (floors.empty()) {
    throw InputError("--filter",
                     fmt::format("no case's \"stage/size\" contains '{}'{}", filter,
                                 is_any_slow ? " but those that run with --long only" : ""));
  }
  for (const std::string& floor : floors) {
    Register(NameOfFloor(floor), Floors().at(floor).loop, Floors().at(floor).iterations);
  }
}

Ratios RatiosOf(const Times& times) {
  Ratios ratios;
  for (const Case& row : Cases()) {
    if (const auto ratio = RatioOf(times, row)) ratios[row.stage][row.size] = Rounded(*ratio);
  }
  return ratios;
}

// Cases that were not run keep their ratios; cases that no longer exist are dropped.
Ratios Renewed(const Ratios& before, const Ratios& ratios) {
  Ratios all;
  for (const Case& row : Cases()) {
    const auto now = Find(ratios, row);
    const auto kept = now ? now : Find(before, row);
    if (kept) all[row.stage][row.size] = Rounded(*kept);
  }
  return all;
}

std::string TablesOf(const Times& times, const Ratios& baseline, double band) {
  std::string text;
  std::string slower;
  std::string faster;
  std::string stage;
  for (const Case& row : Cases()) {
    const auto ratio = RatioOf(times, row);
    if (!ratio) continue;
    if (row.stage != stage) {
      stage = row.stage;
      text += fmt::format("\n| {:46} | {:>9} | {:>7} | {:32} | {:>8} |\n", stage, "time", "times",
                          "its floor or reference", "change");
      text += fmt::format("|{:-<48}|{:-<10}:|{:-<8}:|{:-<34}|{:-<9}:|\n", "", "", "", "", "");
    }
    const auto before = Find(baseline, row);
    text += fmt::format("| {:46} | {:>9} | {:>7.3g} | {:32} | {:>8} |\n", row.size,
                        TimeText(times.at(NameOf(row))), *ratio, LabelOf(row.floor),
                        ChangeText(*ratio, before, band));
    if (!before) continue;
    const std::string line =
        fmt::format("  {}, {}: {:.3g} -> {:.3g} times\n", row.stage, row.size, *before, *ratio);
    if (*ratio > (1.0 + band) * *before) slower += line;
    if (*ratio < (1.0 - band) * *before) faster += line;
  }
  if (baseline.empty()) return text;
  text += fmt::format("\nSlower than the baseline by more than {:.0f} %:{}", 100.0 * band,
                      slower.empty() ? " nothing\n" : "\n" + slower);
  text += fmt::format("Faster than the baseline by more than {:.0f} %:{}", 100.0 * band,
                      faster.empty() ? " nothing\n" : "\n" + faster);
  return text;
}

}  // namespace depthgrid::bench
