#include "eval/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "eval/statistics/holm.h"
#include "eval/statistics/metric_direction.h"
#include "eval/statistics/sample_size.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// What is compared when nothing is asked for: one or two figures of each kind.
constexpr std::array<const char*, 13> kHeadlines = {"trajectory.est.mean_euclidean_m",
                                                    "trajectory.est.ate_rmse_se2_m",
                                                    "trajectory.online.mean_euclidean_m",
                                                    "map.observable.occupied.f1",
                                                    "map.observable.free.f1",
                                                    "map.chamfer_m",
                                                    "map.coverage",
                                                    "map.registered.chamfer_m",
                                                    "map.double_wall_rate",
                                                    "map.ssim",
                                                    "map.calibration.brier",
                                                    "map.navigability.success_rate",
                                                    "map.navigability.collision_rate"};

using Key = std::vector<std::string>;

// 0.5 and 0.50 are the same value.
std::string Canonical(const SweepParameter& parameter, std::size_t row) {
  const double number = parameter.numbers[row];
  return std::isnan(number) ? parameter.texts[row] : fmt::format("{}", number);
}

std::string Canonical(const std::string& text) {
  try {
    std::size_t used = 0;
    const double number = std::stod(text, &used);
    if (used == text.size()) return fmt::format("{}", number);
  } catch (const std::exception&) {  // a word
  }
  return text;
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

std::vector<std::size_t> RowsThatMeet(const SweepResults& table,
                                      const std::vector<Condition>& where) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.failures[row].empty()) rows.push_back(row);
  }
  for (const auto& [key, value] : where) {
    const SweepParameter& parameter = table.Parameter(key);
    std::erase_if(rows,
                  [&](std::size_t row) { return Canonical(parameter, row) != Canonical(value); });
    if (rows.empty()) {
      throw InputError(table.folder, fmt::format("no run has {} = {}", key, value));
    }
  }
  return rows;
}

// The first axis beside the shared ones in which two rows differ, or "".
std::string WhatDiffers(const SweepResults& table, std::size_t row, std::size_t other) {
  for (const SweepParameter& parameter : table.parameters) {
    if (Canonical(parameter, row) != Canonical(parameter, other)) return parameter.key;
  }
  return "";
}

std::map<Key, std::size_t> RowsByKey(const SweepResults& table,
                                     const std::vector<std::size_t>& rows,
                                     const std::vector<std::string>& shared) {
  std::map<Key, std::size_t> by_key;
  for (const std::size_t row : rows) {
    Key key;
    for (const std::string& axis : shared) key.push_back(Canonical(table.Parameter(axis), row));
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

struct Pairs {
  std::vector<std::size_t> a;
  std::vector<std::size_t> b;
  std::vector<std::string> unit;  // pairs of one are averaged: they do not vary on their own
};

// A seed's runs share its noise and its SLAM's errors whatever else they differ in, so the seeds
// are what varies (`seed`, `slam_seed` and their like). Of one seed alone, or without such an axis,
// each pair is a unit.
std::vector<std::string> UnitsOf(const std::vector<Key>& keys,
                                 const std::vector<std::string>& paired_by) {
  std::vector<std::string> units;
  for (const Key& key : keys) {
    std::string unit;
    for (std::size_t axis = 0; axis < key.size(); ++axis) {
      if (paired_by[axis].ends_with("seed")) unit += key[axis] + " ";
    }
    units.push_back(unit);
  }
  if (std::set<std::string>(units.begin(), units.end()).size() > 1) return units;
  for (std::size_t i = 0; i < units.size(); ++i) units[i] = std::to_string(i);
  return units;
}

Pairs PairsOf(const SweepResults& a, const SweepResults& b, const CompareOptions& options,
              Comparison& comparison) {
  comparison.paired_by = SharedAxes(a, b, options);
  const auto rows_a = RowsByKey(a, RowsThatMeet(a, options.where_a), comparison.paired_by);
  const auto rows_b = RowsByKey(b, RowsThatMeet(b, options.where_b), comparison.paired_by);
  Pairs pairs;
  std::vector<Key> keys;
  for (const auto& [key, row] : rows_a) {
    const auto other = rows_b.find(key);
    if (other == rows_b.end()) continue;
    pairs.a.push_back(row);
    pairs.b.push_back(other->second);
    keys.push_back(key);
  }
  pairs.unit = UnitsOf(keys, comparison.paired_by);
  comparison.runs_a = static_cast<int>(rows_a.size());
  comparison.runs_b = static_cast<int>(rows_b.size());
  comparison.pairs = static_cast<int>(pairs.a.size());
  comparison.units =
      static_cast<int>(std::set<std::string>(pairs.unit.begin(), pairs.unit.end()).size());
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

// Of the pairs in which both are defined; empty when there is none.
std::optional<MetricComparison> CompareMetric(const SweepResults& a, const SweepResults& b,
                                              const std::string& name, const Pairs& pairs,
                                              const CompareOptions& options) {
  struct Sum {
    double a = 0.0;
    double b = 0.0;
    int count = 0;
  };
  std::map<std::string, Sum> by_unit;
  for (std::size_t i = 0; i < pairs.a.size(); ++i) {
    const double value_a = a.Metric(name)[pairs.a[i]];
    const double value_b = b.Metric(name)[pairs.b[i]];
    if (!std::isfinite(value_a) || !std::isfinite(value_b)) continue;
    Sum& sum = by_unit[pairs.unit[i]];
    sum.a += value_a;
    sum.b += value_b;
    ++sum.count;
  }
  std::vector<double> of_a, of_b;
  for (const auto& [unit, sum] : by_unit) {
    of_a.push_back(sum.a / sum.count);
    of_b.push_back(sum.b / sum.count);
  }
  if (of_a.empty()) return std::nullopt;
  MetricComparison result;
  result.metric = name;
  result.better = BetterOf(name);
  result.paired =
      ComparePaired(of_a, of_b, result.better, Resamples(of_a.size(), options.bootstrap));
  return result;
}

// `least_p_holm`: the row's p-value if in every row all differences had one sign.
Verdict VerdictOf(const MetricComparison& c, double least_p_holm, double level) {
  if (least_p_holm >= level) return Verdict::kTooFew;
  if (c.p_holm >= level) return Verdict::kNotToldApart;
  const bool b_is_higher = c.paired.wilcoxon.rank_biserial > 0.0;
  return b_is_higher == (c.better == Better::kHigher) ? Verdict::kBBetter : Verdict::kABetter;
}

int MostRowsToldApart(const std::vector<MetricComparison>& rows, double level) {
  int pairs = 0;
  for (const MetricComparison& row : rows) pairs = std::max(pairs, row.paired.pairs);
  int most = static_cast<int>(rows.size());
  while (most > 0 && most * LeastWilcoxonP(pairs) >= level) --most;
  return most;
}

// Of a table of that many rows: each is judged as the first of them is, whose p-value Holm takes
// times all of them. What so many pairs did not show takes more.
std::optional<int> SeedsNeededIn(std::size_t rows, const MetricComparison& c, double level) {
  const PairedComparison& paired = c.paired;
  if (paired.mean_difference == 0.0 || paired.pairs < 2) return std::nullopt;
  TestPlan plan;
  plan.level = level / static_cast<double>(rows);
  auto needed = SeedsNeededByRanks(paired.mean_difference, paired.std_difference, plan);
  const bool is_shown = c.verdict == Verdict::kABetter || c.verdict == Verdict::kBBetter;
  if (needed && !is_shown) needed = std::max(*needed, paired.pairs + 1);
  return needed;
}

}  // namespace

Comparison Compare(const SweepResults& a, const SweepResults& b, const CompareOptions& options) {
  Comparison comparison;
  const Pairs pairs = PairsOf(a, b, options, comparison);
  std::vector<double> p_values, least_p_values;
  for (const std::string& name : MetricsToCompare(a, b, options.metrics)) {
    if (auto compared = CompareMetric(a, b, name, pairs, options)) {
      p_values.push_back(compared->paired.wilcoxon.p_value);
      least_p_values.push_back(LeastWilcoxonP(compared->paired.pairs));
      comparison.metrics.push_back(std::move(*compared));
    }
  }
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  const std::vector<double> least = HolmAdjusted(least_p_values);
  for (std::size_t i = 0; i < adjusted.size(); ++i) {
    MetricComparison& compared = comparison.metrics[i];
    compared.p_holm = adjusted[i];
    compared.verdict = VerdictOf(compared, least[i], options.level);
    compared.seeds_needed = SeedsNeededIn(adjusted.size(), compared, options.level);
  }
  comparison.most_rows = MostRowsToldApart(comparison.metrics, options.level);
  return comparison;
}

}  // namespace depthgrid
