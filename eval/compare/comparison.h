// Compares two configurations over the same seeds: which is better in each score, and how
// significantly (docs/statistics.md, "Comparing").
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eval/statistics/paired_comparison.h"
#include "eval/sweep/sweep_results.h"

namespace depthgrid {

using Condition = std::pair<std::string, std::string>;  // axis and YAML value

struct CompareOptions {
  std::vector<std::string> metrics;  // empty: ScoresToCompare()
  // Only runs with these values count, for each side.
  std::vector<Condition> where_a;
  std::vector<Condition> where_b;
  double level = 0.05;  // of all tests together
  BootstrapOptions bootstrap;
};

enum class Verdict {
  kABetter,
  kBBetter,
  kNotToldApart,
  kTooFew,     // with so few pairs and so many rows no values could be significant
  kNotTested,  // left out by default, because there are too few pairs for all scores
  kAHigher,    // for scores for which neither is better
  kBHigher,
};

struct MetricComparison {
  std::string metric;
  Better better = Better::kLower;
  std::optional<double> target;  // if the score has one, all values are distances from it
  PairedComparison paired;
  int undefined_pairs = 0;  // pairs of runs in which the score is undefined on either side
  double p_holm = 1.0;      // over the tested rows
  Verdict verdict = Verdict::kNotToldApart;
  // Number of seeds at which a difference of this size would be detected with 80 % power in a table
  // of as many rows; more than the present number unless it is detected now. Empty where the
  // difference is zero.
  std::optional<int> seeds_needed;
};

struct DifferentSetting {
  std::string key;
  std::string a;  // the only value on each side
  std::string b;
};

// How the runs of the two sides were paired.
struct Pairing {
  std::vector<std::string> paired_by;  // the axes whose values make a pair
  // Settings with a single value on each side, but not the same one.
  std::vector<DifferentSetting> different;
  int pairs = 0;  // number of pairs that count
  // Sample size of the tests: pairs with the same seed are averaged and count as one.
  int units = 0;
  // Crossed seed axes; the units are as many as the smallest has (SeedUnits).
  std::vector<std::string> crossed_seeds;
  int runs_a = 0;  // runs that meet the conditions and did not fail
  int runs_b = 0;
  int unpaired_a = 0;  // of these, without a partner on the other side
  int unpaired_b = 0;
  // Seeds not counted because they gave the same as another one in every score.
  int repeated_seeds = 0;
};

struct Comparison : Pairing {
  std::vector<MetricComparison> metrics;  // with at least one pair in which both are defined
  std::vector<std::string> undefined;     // scores undefined in every pair on one side or the other
  // With `--metric all`: not tested, because neither direction is better.
  std::vector<std::string> without_direction;
  std::vector<std::string> all_equal;  // equal on both sides in every pair
  int most_rows = 0;                   // number of rows that so many pairs can decide together
  int pairs_for_one = 0;               // number of pairs needed to decide one row, and all rows
  int pairs_for_all = 0;
};

// Throws InputError for an unknown metric or axis, for runs that form no pair or several, and for
// sides whose runs saw different things.
Comparison Compare(SweepResults a, SweepResults b, const CompareOptions& options);

std::string ComparisonJson(const Comparison& comparison, const std::string& a,
                           const std::string& b);

}  // namespace depthgrid
