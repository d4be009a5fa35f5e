#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/compare/comparison.h"
#include "eval/compare/run_collection.h"
#include "eval/files/metric_columns.h"
#include "eval/statistics/metric_direction.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {
namespace {

// `option`: the name of the option that gave `own`.
std::vector<Condition> ConditionsOf(const std::vector<std::string>& both, const char* option,
                                    const std::vector<std::string>& own) {
  std::vector<Condition> conditions;
  for (const auto& [name, list] : {std::pair("--where", &both), std::pair(option, &own)}) {
    for (const std::string& text : *list) {
      const auto equals = text.find('=');
      if (equals == std::string::npos || equals == 0) {
        throw InputError(name, fmt::format("is '{}', must be key.path=value", text));
      }
      conditions.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
  }
  return conditions;
}

// The test uses ranks, so the mean may have the other sign because of a few large differences.
std::string BetterByRanks(const char* side, bool mean_agrees) {
  return fmt::format("{} better{}", side, mean_agrees ? "" : " by ranks, not by the mean");
}

std::string TextOf(const MetricComparison& c) {
  const bool mean_is_higher = c.paired.mean_difference > 0.0;
  const bool ranks_are_higher = c.paired.wilcoxon.rank_biserial > 0.0;
  const bool mean_agrees = mean_is_higher == ranks_are_higher;
  switch (c.verdict) {
    case Verdict::kABetter:
      return BetterByRanks("A", mean_agrees);
    case Verdict::kBBetter:
      return BetterByRanks("B", mean_agrees);
    case Verdict::kAHigher:
      return "A higher";
    case Verdict::kBHigher:
      return "B higher";
    case Verdict::kTooFew:
      return "too few pairs";
    case Verdict::kNotTested:
      return "not tested";
    case Verdict::kNotToldApart:
      break;
  }
  return "not told apart";
}

std::vector<std::string> RowOf(const MetricComparison& c) {
  const PairedComparison& p = c.paired;
  const std::string interval =
      p.mean_interval
          ? fmt::format("[{}, {}]", Short(p.mean_interval->low), Short(p.mean_interval->high))
          : "-";
  // For a score with a target, the distance from it is compared.
  const std::string what = c.target ? DistanceName(c.metric, *c.target) : c.metric;
  return {what,
          c.better == Better::kNeither ? "-" : NameOf(c.better),
          Short(p.mean_a),
          Short(p.mean_b),
          fmt::format("{:+.4g}", p.mean_difference),
          interval,
          c.better == Better::kNeither ? "-" : fmt::format("{}:{}", p.a_wins, p.b_wins),
          fmt::format("{:.3g}", p.wilcoxon.p_value),
          c.verdict == Verdict::kNotTested ? "-" : fmt::format("{:.3g}", c.p_holm),
          c.seeds_needed ? std::to_string(*c.seeds_needed) : "-",
          TextOf(c)};
}

// Lists rows with fewer pairs than the table's head states.
void PrintFewerPairs(const Comparison& comparison) {
  std::vector<std::string> rows;
  for (const MetricComparison& c : comparison.metrics) {
    if (c.undefined_pairs == 0) continue;
    rows.push_back(fmt::format(
        "{} ({} of {}{})", c.metric, comparison.pairs - c.undefined_pairs,
        Counted(comparison.pairs, "pair"),
        c.paired.pairs < comparison.units && comparison.units < comparison.pairs
            ? fmt::format(", {} of {}", c.paired.pairs, Counted(comparison.units, "seed"))
            : ""));
  }
  if (rows.empty()) return;
  fmt::print("\nOn fewer pairs, as the score is not defined on both sides in the others: {}\n",
             fmt::join(rows, ", "));
}

void PrintLeftOut(const Comparison& comparison) {
  const auto print = [](const std::vector<std::string>& names, const char* why) {
    if (names.empty()) return;
    fmt::print("\n{} left out, {}: {}\n", Counted(names.size(), "score"), why,
               fmt::join(names, ", "));
  };
  print(comparison.undefined, "not defined on both sides in any pair");
  print(comparison.all_equal, "the same on both sides in every pair");
  print(comparison.without_direction, "of which neither more nor less is better");
}

// Prints how many pairs a verdict needs, if there are too few for every row.
void PrintTooFew(const Comparison& comparison) {
  const int most = comparison.most_rows;
  const int rows = static_cast<int>(comparison.metrics.size());
  if (most >= rows) return;
  const char* unit = comparison.units < comparison.pairs ? "seed" : "pair";
  const std::string all = rows == 1 ? ""
                                    : fmt::format(", all {} rows need {}", rows,
                                                  Counted(comparison.pairs_for_all, unit));
  if (most == 0) {
    fmt::print("\nToo few {}s for any verdict: one row needs {}{}.\n", unit,
               Counted(comparison.pairs_for_one, unit), all);
    return;
  }
  const bool some_are_not =
      std::any_of(comparison.metrics.begin(), comparison.metrics.end(),
                  [](const MetricComparison& c) { return c.verdict == Verdict::kNotTested; });
  fmt::print(
      "\n{} are enough to test {} at once{}{}. Choose the scores with --metric, before looking at "
      "any.\n",
      Counted(comparison.units, unit), Counted(most, "row"), all,
      some_are_not ? "; the others are not tested" : "");
}

void PrintTable(const Comparison& comparison, const CompareArguments& arguments) {
  fmt::print("A: {} ({})\nB: {} ({})\n{}", arguments.a, Counted(comparison.runs_a, "run"),
             arguments.b, Counted(comparison.runs_b, "run"), Counted(comparison.pairs, "pair"));
  if (!comparison.paired_by.empty()) {
    fmt::print(", paired by {}", fmt::join(comparison.paired_by, ", "));
  }
  for (const DifferentSetting& setting : comparison.different) {
    fmt::print("; {} is {} in A, {} in B", setting.key, setting.a, setting.b);
  }
  if (!comparison.crossed_seeds.empty()) {
    fmt::print("; {} are crossed: as sure as {}", fmt::join(comparison.crossed_seeds, " and "),
               Counted(comparison.units, "seed"));
  } else if (comparison.units < comparison.pairs) {
    fmt::print("; {}, whose pairs are averaged", Counted(comparison.units, "seed"));
  }
  if (comparison.repeated_seeds > 0) {
    fmt::print("; not counted, as every score equals that of another: {}",
               Counted(comparison.repeated_seeds, "seed"));
  }
  if (comparison.unpaired_a > 0 || comparison.unpaired_b > 0) {
    fmt::print("; left out for want of a partner: {} of A, {} of B",
               Counted(comparison.unpaired_a, "run"), comparison.unpaired_b);
  }
  std::vector<std::vector<std::string>> rows = {{"metric", "better", "A", "B", "B - A",
                                                 "95 % interval", "wins A:B", "p", "p Holm",
                                                 "seeds needed", "verdict"}};
  for (const MetricComparison& compared : comparison.metrics) rows.push_back(RowOf(compared));
  fmt::print("\n\n{}", comparison.metrics.empty() ? "" : Table(rows));
  PrintFewerPairs(comparison);
  PrintLeftOut(comparison);
  PrintTooFew(comparison);
}

}  // namespace

void CompareRuns(const CompareArguments& arguments) {
  CompareOptions options;
  options.metrics = arguments.metrics;
  options.where_a = ConditionsOf(arguments.where, "--where-a", arguments.where_a);
  options.where_b = ConditionsOf(arguments.where, "--where-b", arguments.where_b);
  SweepResults a = ReadRuns(arguments.a);  // first, so that an error names it first
  SweepResults b = ReadRuns(arguments.b);
  const Comparison comparison = Compare(std::move(a), std::move(b), options);
  if (comparison.metrics.empty() && comparison.all_equal.empty() &&
      comparison.without_direction.empty()) {
    throw InputError(arguments.b, "shares no score that is defined with " + arguments.a);
  }
  std::error_code missing;
  if (options.where_a == options.where_b &&
      std::filesystem::equivalent(arguments.a, arguments.b, missing)) {
    Warn({"A and B are the same runs; --where-a and --where-b choose among those of one sweep"});
  }
  if (arguments.json) {
    fmt::print("{}", ComparisonJson(comparison, arguments.a, arguments.b));
  } else {
    PrintTable(comparison, arguments);
  }
}

}  // namespace depthgrid::cli
