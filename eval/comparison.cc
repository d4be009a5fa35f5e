#include "eval/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

#include "eval/statistics/holm.h"
#include "eval/statistics/metric_direction.h"
#include "eval/statistics/sample_size.h"
#include "eval/statistics/seed_units.h"
#include "eval/sweep/sweep_axes.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// What is compared when nothing is asked for: one or two figures of each kind, those first that
// should be tested where there are pairs for a few only.
constexpr std::array<const char*, 13> kHeadlines = {"trajectory.est.mean_euclidean_m",
                                                    "map.observable.occupied.f1",
                                                    "trajectory.est.ate_rmse_se2_m",
                                                    "map.chamfer_m",
                                                    "trajectory.online.mean_euclidean_m",
                                                    "map.coverage",
                                                    "map.observable.free.f1",
                                                    "map.registered.chamfer_m",
                                                    "map.double_wall_rate",
                                                    "map.ssim",
                                                    "map.calibration.brier",
                                                    "map.navigability.success_rate",
                                                    "map.navigability.collision_rate"};

using Key = std::vector<std::string>;

// 0.5 and 0.50 are the same value; seeds that no double holds stay apart.
std::string ValueAt(const SweepParameter& parameter, std::size_t row) {
  return ShortestYaml(parameter.texts[row]);
}

bool HasAxis(const SweepResults& table, const std::string& key) {
  return std::any_of(table.parameters.begin(), table.parameters.end(),
                     [&](const SweepParameter& p) { return p.key == key; });
}

bool IsFixed(const std::vector<Condition>& where, const std::string& key) {
  return std::any_of(where.begin(), where.end(),
                     [&](const Condition& c) { return c.first == key; });
}

// Axes of both that no condition fixes.
std::vector<std::string> SharedAxes(const SweepResults& a, const SweepResults& b,
                                    const CompareOptions& options) {
  std::vector<std::string> keys;
  for (const SweepParameter& parameter : a.parameters) {
    const std::string& key = parameter.key;
    if (!HasAxis(b, key) || IsFixed(options.where_a, key) || IsFixed(options.where_b, key))
      continue;
    keys.push_back(key);
  }
  return keys;
}

// The text that a sweep has of a value written as in its file: "[1, 1, 0]" of "[1,1,0]".
std::string AsOnAxis(const std::string& value) {
  if (!value.starts_with("[")) return ShortestYaml(value);
  Config config;
  config.Set("value", value, "--where");
  return config.Entries().front().text;
}

// The first values, each once; how many more there are.
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

// The first axis beside the shared ones in which two rows differ, or "".
std::string WhatDiffers(const SweepResults& table, std::size_t row, std::size_t other) {
  for (const SweepParameter& parameter : table.parameters) {
    if (ValueAt(parameter, row) != ValueAt(parameter, other)) return parameter.key;
  }
  return "";
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
                         ? "holds several runs that make the same pair"
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
  Key rest;  // of what it is paired by
};

struct Pairs {
  std::vector<std::size_t> a;
  std::vector<std::size_t> b;
  SeedUnits units{{}};
};

void AddScores(const SweepResults& table, std::size_t row, std::vector<std::uint64_t>& bits) {
  for (const SweepColumn& column : table.metrics) {
    bits.push_back(std::bit_cast<std::uint64_t>(column.values[row]));
  }
}

// Seeds that gave what another one gave in every score of every pair, as where nothing is random:
// one measurement, however often it was made.
std::set<Key> RepeatedSeeds(const SweepResults& a, const SweepResults& b,
                            const std::vector<Pair>& pairs) {
  using Scores = std::map<Key, std::vector<std::uint64_t>>;
  std::map<Key, Scores> by_seed;
  for (const Pair& pair : pairs) {
    std::vector<std::uint64_t>& bits = by_seed[pair.seeds][pair.rest];
    AddScores(a, pair.a, bits);
    AddScores(b, pair.b, bits);
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

Pairs PairsOf(const SweepResults& a, const SweepResults& b, const CompareOptions& options,
              Comparison& comparison) {
  comparison.paired_by = SharedAxes(a, b, options);
  const auto rows_a = RowsByKey(a, RowsThatMeet(a, options.where_a), comparison.paired_by);
  const auto rows_b = RowsByKey(b, RowsThatMeet(b, options.where_b), comparison.paired_by);
  const std::vector<std::size_t> seed_axes = SeedAxes(comparison.paired_by);
  std::vector<Pair> found = JoinRows(rows_a, rows_b, seed_axes);
  comparison.runs_a = static_cast<int>(rows_a.size());
  comparison.runs_b = static_cast<int>(rows_b.size());
  comparison.unpaired_a = static_cast<int>(rows_a.size() - found.size());
  comparison.unpaired_b = static_cast<int>(rows_b.size() - found.size());
  const std::set<Key> repeated = RepeatedSeeds(a, b, found);
  comparison.repeated_seeds = static_cast<int>(repeated.size());
  std::erase_if(found, [&](const Pair& pair) { return repeated.contains(pair.seeds); });
  Pairs pairs;
  std::vector<Key> seeds;
  for (Pair& pair : found) {
    pairs.a.push_back(pair.a);
    pairs.b.push_back(pair.b);
    seeds.push_back(std::move(pair.seeds));
  }
  pairs.units = SeedUnits(seeds);
  for (const std::size_t axis : pairs.units.crossed()) {
    comparison.crossed_seeds.push_back(comparison.paired_by[seed_axes[axis]]);
  }
  comparison.pairs = static_cast<int>(pairs.a.size());
  comparison.units = static_cast<int>(pairs.units.count());
  if (pairs.a.empty()) {
    throw InputError(b.folder, fmt::format("shares no run with {} (by {})", a.folder,
                                           fmt::join(comparison.paired_by, ", ")));
  }
  return pairs;
}

bool HasMetric(const SweepResults& table, const std::string& name) {
  return std::any_of(table.metrics.begin(), table.metrics.end(),
                     [&](const SweepColumn& column) { return column.name == name; });
}

std::vector<std::string> MetricsToCompare(const SweepResults& a, const SweepResults& b,
                                          const std::vector<std::string>& asked) {
  std::vector<std::string> names;
  if (asked == std::vector<std::string>{"all"}) {
    for (const SweepColumn& column : a.metrics) names.push_back(column.name);
  } else if (asked.empty()) {
    names.assign(kHeadlines.begin(), kHeadlines.end());
  } else {
    return asked;
  }
  std::erase_if(names, [&](const std::string& n) { return !HasMetric(a, n) || !HasMetric(b, n); });
  return names;
}

// One figure a unit, of the pairs in which both sides are defined; distances from the target of a
// score that has one.
struct UnitFigures {
  std::vector<double> a;
  std::vector<double> b;
};

UnitFigures FiguresOf(const SweepResults& a, const SweepResults& b, const std::string& name,
                      const Pairs& pairs) {
  const auto target = TargetOf(name);
  const auto figure = [&](double value) { return target ? std::abs(value - *target) : value; };
  std::vector<double> of_a(pairs.a.size(), NAN), of_b(pairs.a.size(), NAN);
  for (std::size_t i = 0; i < pairs.a.size(); ++i) {
    const double value_a = a.Metric(name)[pairs.a[i]];
    const double value_b = b.Metric(name)[pairs.b[i]];
    if (!std::isfinite(value_a) || !std::isfinite(value_b)) continue;
    of_a[i] = figure(value_a);
    of_b[i] = figure(value_b);
  }
  UnitFigures units{pairs.units.Figures(of_a), pairs.units.Figures(of_b)};
  std::erase_if(units.a, [](double v) { return std::isnan(v); });
  std::erase_if(units.b, [](double v) { return std::isnan(v); });
  return units;
}

// Empty when there is no pair.
std::optional<MetricComparison> CompareMetric(const SweepResults& a, const SweepResults& b,
                                              const std::string& name, const Pairs& pairs,
                                              const CompareOptions& options) {
  const UnitFigures units = FiguresOf(a, b, name, pairs);
  if (units.a.empty()) return std::nullopt;
  MetricComparison result;
  result.metric = name;
  result.better = BetterOf(name);
  result.target = TargetOf(name);
  result.paired =
      ComparePaired(units.a, units.b, result.better, Resamples(units.a.size(), options.bootstrap));
  return result;
}

// `least_p_holm`: the row's p-value if in every row all differences had one sign.
Verdict VerdictOf(const MetricComparison& c, double least_p_holm, double level) {
  if (least_p_holm >= level) return Verdict::kTooFew;
  if (c.p_holm >= level) return Verdict::kNotToldApart;
  const bool b_is_higher = c.paired.wilcoxon.rank_biserial > 0.0;
  if (c.better == Better::kNeither) return b_is_higher ? Verdict::kBHigher : Verdict::kAHigher;
  return b_is_higher == (c.better == Better::kHigher) ? Verdict::kBBetter : Verdict::kABetter;
}

int MostRowsToldApart(const std::vector<MetricComparison>& rows, double level) {
  int pairs = 0;
  for (const MetricComparison& row : rows) pairs = std::max(pairs, row.paired.pairs);
  int most = static_cast<int>(rows.size());
  while (most > 0 && most * LeastWilcoxonP(pairs) >= level) --most;
  return most;
}

int PairsToTellApart(int rows, double level) {
  int pairs = 1;
  while (rows * LeastWilcoxonP(pairs) >= level) ++pairs;
  return pairs;
}

// Which rows are tested: those asked for all are. Of the headlines, where so few pairs cannot tell
// all of them apart, the first that they can: a choice made without a look at the signs of the
// differences keeps the chance of a false alarm, and a verdict on one row says more than none on
// thirteen. Rows that are equal in every pair cannot decide and would take the place of others.
std::vector<std::size_t> RowsToTest(const Comparison& comparison, bool are_headlines) {
  const std::vector<MetricComparison>& rows = comparison.metrics;
  const auto most = static_cast<std::size_t>(comparison.most_rows);
  const bool choose = are_headlines && most > 0 && most < rows.size();
  std::vector<std::size_t> tested;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool can_decide = rows[i].paired.wilcoxon.pairs > 0 && tested.size() < most;
    if (!choose || can_decide) tested.push_back(i);
  }
  return tested;
}

void Judge(const std::vector<std::size_t>& tested, double level, Comparison& comparison) {
  std::vector<double> p_values, least_p_values;
  for (const std::size_t i : tested) {
    const PairedComparison& paired = comparison.metrics[i].paired;
    p_values.push_back(paired.wilcoxon.p_value);
    least_p_values.push_back(LeastWilcoxonP(paired.pairs));
  }
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  const std::vector<double> least = HolmAdjusted(least_p_values);
  for (MetricComparison& row : comparison.metrics) {
    const bool all_equal = row.paired.wilcoxon.pairs == 0;  // which no test would tell apart
    row.verdict = all_equal ? Verdict::kNotToldApart : Verdict::kNotTested;
  }
  for (std::size_t k = 0; k < tested.size(); ++k) {
    MetricComparison& row = comparison.metrics[tested[k]];
    row.p_holm = adjusted[k];
    row.verdict = VerdictOf(row, least[k], level);
  }
}

// Of a table of that many rows: each is judged as the first of them is, whose p-value Holm takes
// times all of them. What so many pairs did not show takes more.
std::optional<int> SeedsNeededIn(std::size_t rows, const MetricComparison& c, double level) {
  const PairedComparison& paired = c.paired;
  if (paired.mean_difference == 0.0 || paired.pairs < 2) return std::nullopt;
  TestPlan plan;
  plan.level = level / static_cast<double>(rows);
  auto needed = SeedsNeededByRanks(paired.mean_difference, paired.std_difference, plan);
  const bool is_shown = c.verdict != Verdict::kNotToldApart && c.verdict != Verdict::kTooFew &&
                        c.verdict != Verdict::kNotTested;
  if (needed && !is_shown) needed = std::max(*needed, paired.pairs + 1);
  return needed;
}

// Of all scores there are, which ones make no row: they would only cost the others Holm's
// correction (one that is equal in every pair has a p-value of 1 whatever the level; Tarone 1990).
bool IsLeftOut(const MetricComparison& compared, Comparison& comparison) {
  if (compared.better == Better::kNeither) {
    comparison.without_direction.push_back(compared.metric);
    return true;
  }
  const bool all_equal = compared.paired.wilcoxon.pairs == 0;
  if (all_equal) comparison.all_equal.push_back(compared.metric);
  return all_equal;
}

}  // namespace

Comparison Compare(const SweepResults& a, const SweepResults& b, const CompareOptions& options) {
  Comparison comparison;
  const Pairs pairs = PairsOf(a, b, options, comparison);
  const bool of_all = options.metrics == std::vector<std::string>{"all"};
  for (const std::string& name : MetricsToCompare(a, b, options.metrics)) {
    auto compared = CompareMetric(a, b, name, pairs, options);
    if (!compared) comparison.undefined.push_back(name);
    if (!compared || (of_all && IsLeftOut(*compared, comparison))) continue;
    comparison.metrics.push_back(std::move(*compared));
  }
  const std::size_t rows = comparison.metrics.size();
  comparison.most_rows = MostRowsToldApart(comparison.metrics, options.level);
  comparison.pairs_for_one = PairsToTellApart(1, options.level);
  comparison.pairs_for_all = PairsToTellApart(static_cast<int>(rows), options.level);
  Judge(RowsToTest(comparison, options.metrics.empty()), options.level, comparison);
  for (MetricComparison& row : comparison.metrics) {
    row.seeds_needed = SeedsNeededIn(rows, row, options.level);
  }
  return comparison;
}

}  // namespace depthgrid
