#include <fmt/format.h>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/comparison.h"
#include "eval/run_collection.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {
namespace {

std::vector<Condition> ConditionsOf(const std::vector<std::string>& both,
                                    const std::vector<std::string>& own) {
  std::vector<Condition> conditions;
  for (const auto* list : {&both, &own}) {
    for (const std::string& text : *list) {
      const auto equals = text.find('=');
      if (equals == std::string::npos || equals == 0) {
        throw InputError("--where", fmt::format("is '{}', must be key.path=value", text));
      }
      conditions.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
  }
  return conditions;
}

const char* TextOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kABetter:
      return "A better";
    case Verdict::kBBetter:
      return "B better";
    case Verdict::kTooFew:
      return "too few pairs";
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
  return {c.metric,
          c.better == Better::kHigher ? "higher" : "lower",
          Short(p.mean_a),
          Short(p.mean_b),
          fmt::format("{:+.4g}", p.mean_difference),
          interval,
          fmt::format("{}:{}", p.a_wins, p.b_wins),
          fmt::format("{:.3g}", p.wilcoxon.p_value),
          fmt::format("{:.3g}", c.p_holm),
          c.seeds_needed ? std::to_string(*c.seeds_needed) : "-",
          TextOf(c.verdict)};
}

void PrintTable(const Comparison& comparison, const CompareArguments& arguments) {
  fmt::print("A: {} ({})\nB: {} ({})\n{}", arguments.a, Counted(comparison.runs_a, "run"),
             arguments.b, Counted(comparison.runs_b, "run"), Counted(comparison.pairs, "pair"));
  if (!comparison.paired_by.empty()) {
    fmt::print(", paired by {}", fmt::join(comparison.paired_by, ", "));
  }
  if (comparison.units < comparison.pairs) {
    fmt::print("; {}, whose pairs are averaged", Counted(comparison.units, "seed"));
  }
  std::vector<std::vector<std::string>> rows = {{"metric", "better", "A", "B", "B - A",
                                                 "95 % interval", "wins A:B", "p", "p Holm",
                                                 "seeds needed", "verdict"}};
  for (const MetricComparison& compared : comparison.metrics) rows.push_back(RowOf(compared));
  fmt::print("\n\n{}", Table(rows));
  const int most = comparison.most_rows;
  if (most > 0 && most < static_cast<int>(comparison.metrics.size())) {
    fmt::print(
        "\nToo few pairs for Holm's correction over {}, enough for {}: choose with --metric "
        "what is asked, before looking.\n",
        Counted(static_cast<int>(comparison.metrics.size()), "row"), most);
  }
}

}  // namespace

void CompareRuns(const CompareArguments& arguments) {
  CompareOptions options;
  options.metrics = arguments.metrics;
  options.where_a = ConditionsOf(arguments.where, arguments.where_a);
  options.where_b = ConditionsOf(arguments.where, arguments.where_b);
  const SweepResults a = ReadRuns(arguments.a);
  const SweepResults b = ReadRuns(arguments.b);
  const Comparison comparison = Compare(a, b, options);
  if (comparison.metrics.empty()) {
    throw InputError(arguments.b, "shares no score that is defined with " + arguments.a);
  }
  if (arguments.json) {
    fmt::print("{}", ComparisonJson(comparison, arguments.a, arguments.b));
  } else {
    PrintTable(comparison, arguments);
  }
}

}  // namespace depthgrid::cli
