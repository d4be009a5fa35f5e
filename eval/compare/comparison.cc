#include "eval/compare/comparison.h"

#include <algorithm>
#include <cmath>

#include "eval/compare/comparison_pairs.h"
#include "eval/compare/fixed_settings.h"
#include "eval/statistics/holm.h"
#include "eval/statistics/metric_direction.h"
#include "eval/statistics/sample_size.h"
#include "eval/statistics/score_names.h"

namespace depthgrid {
namespace {

bool HasMetric(const SweepResults& table, const std::string& name) {
  return std::any_of(table.metrics.begin(), table.metrics.end(),
                     [&](const SweepColumn& column) { return column.name == name; });
}

std::vector<std::string> MetricsToCompare(const SweepResults& a, const SweepResults& b,
                                          const std::vector<std::string>& asked) {
  std::vector<std::string> names;
  if (asked == std::vector<std::string>{"all"}) {
    for (const SweepColumn& column : a.metrics) names.push_back(column.name);
    for (const SweepColumn& column : b.metrics) {
      if (!HasMetric(a, column.name)) names.push_back(column.name);
    }
  } else if (asked.empty()) {
    names.assign(ScoresToCompare().begin(), ScoresToCompare().end());
  } else {
    for (const std::string& name : asked) {  // a metric given twice is one test
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names;
  }
  std::erase_if(names, [&](const std::string& n) { return !HasMetric(a, n) && !HasMetric(b, n); });
  return names;
}

// One value per unit, from the pairs in which both sides are defined; for scores with a target,
// distances from it.
struct UnitFigures {
  std::vector<double> a;
  std::vector<double> b;
  int undefined_pairs = 0;  // pairs of runs, undefined on one side or the other
};

UnitFigures FiguresOf(const SweepResults& a, const SweepResults& b, const std::string& name,
                      const RunPairs& pairs) {
  const auto target = TargetOf(name);
  const auto figure = [&](double value) { return target ? DistanceFrom(*target, value) : value; };
  std::vector<double> of_a(pairs.a.size(), NAN), of_b(pairs.a.size(), NAN);
  int undefined_pairs = 0;
  for (std::size_t i = 0; i < pairs.a.size(); ++i) {
    const double value_a = a.Metric(name)[pairs.a[i]];
    const double value_b = b.Metric(name)[pairs.b[i]];
    if (!std::isfinite(value_a) || !std::isfinite(value_b)) {
      ++undefined_pairs;
      continue;
    }
    of_a[i] = figure(value_a);
    of_b[i] = figure(value_b);
  }
  UnitFigures units{pairs.units.Figures(of_a), pairs.units.Figures(of_b), undefined_pairs};
  std::erase_if(units.a, [](double v) { return std::isnan(v); });
  std::erase_if(units.b, [](double v) { return std::isnan(v); });
  return units;
}

// Empty when there is no pair.
std::optional<MetricComparison> CompareMetric(const SweepResults& a, const SweepResults& b,
                                              const std::string& name, const RunPairs& pairs,
                                              const CompareOptions& options) {
  const UnitFigures units = FiguresOf(a, b, name, pairs);
  if (units.a.empty()) return std::nullopt;
  MetricComparison result;
  result.metric = name;
  result.better = BetterOf(name);
  result.target = TargetOf(name);
  result.undefined_pairs = units.undefined_pairs;
  result.paired =
      ComparePaired(units.a, units.b, result.better, Resamples(units.a.size(), options.bootstrap));
  return result;
}

// `least_p_holm`: the smallest possible adjusted p-value, with all differences of one sign in every
// row.
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

// Selects the tested rows. Scores asked for are all tested. Of the default scores, if the pairs are
// too few to decide all, only as many of the first ones as they can decide: one verdict is better
// than none on thirteen rows, and a choice independent of the differences' signs keeps the level.
// Rows equal in every pair are skipped, because they cannot be decided.
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
    const bool all_equal = row.paired.wilcoxon.pairs == 0;  // no test could decide it
    row.verdict = all_equal ? Verdict::kNotToldApart : Verdict::kNotTested;
  }
  for (std::size_t k = 0; k < tested.size(); ++k) {
    MetricComparison& row = comparison.metrics[tested[k]];
    row.p_holm = adjusted[k];
    row.verdict = VerdictOf(row, least[k], level);
  }
}

// For a table of `rows` rows, each judged like the first one, whose p-value Holm multiplies by
// their number. More than the present units if the difference was not detected.
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

// Scores that get no row when all are compared, because they would only increase Holm's correction
// for the others (a score that is equal in every pair has p = 1 at any level; Tarone 1990).
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

Comparison Compare(SweepResults a, SweepResults b, const CompareOptions& options) {
  AlignFixedSettings(options, a, b);
  const RunPairs pairs = PairsOf(a, b, options);
  Comparison comparison;
  static_cast<Pairing&>(comparison) = pairs.pairing;
  const bool of_all = options.metrics == std::vector<std::string>{"all"};
  for (const std::string& name : MetricsToCompare(a, b, options.metrics)) {
    // If it was asked for by name, CompareMetric() throws.
    const bool by_name = !options.metrics.empty() && !of_all;
    const bool is_everywhere = HasMetric(a, name) && HasMetric(b, name);
    auto compared =
        by_name || is_everywhere ? CompareMetric(a, b, name, pairs, options) : std::nullopt;
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
