// Two configurations over the same seeds: which is better in each score, and how sure that is
// (docs/statistics.md, "Comparing").
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
  std::vector<std::string> metrics;  // empty: those that say most
  // Only the runs of a side with these values count.
  std::vector<Condition> where_a;
  std::vector<Condition> where_b;
  double level = 0.05;  // of all tests together
  BootstrapOptions bootstrap;
};

enum class Verdict {
  kABetter,
  kBBetter,
  kNotToldApart,
  kTooFew,     // whatever the values, so few pairs cannot decide in a table of so many rows
  kNotTested,  // one of the headlines that so few pairs leave out
  kAHigher,    // of a score of which neither more nor less is better
  kBHigher,
};

struct MetricComparison {
  std::string metric;
  Better better = Better::kLower;
  std::optional<double> target;  // of a score that has one; all figures are of the distance from it
  PairedComparison paired;
  int undefined_pairs = 0;  // of runs, that the score left out, being undefined on either side
  double p_holm = 1.0;      // over the rows that are tested
  Verdict verdict = Verdict::kNotToldApart;
  // Seeds at which a difference as large as this one would be seen with 80 % power in a table of as
  // many rows, more than there are unless it is seen now; empty where it is zero.
  std::optional<int> seeds_needed;
};

struct DifferentSetting {
  std::string key;
  std::string a;  // the only value of either side
  std::string b;
};

struct Comparison {
  std::vector<std::string> paired_by;       // the axes whose values make a pair
  std::vector<DifferentSetting> different;  // axes of both that are not among them
  int pairs = 0;                            // that count
  int units = 0;  // what the tests count: pairs of one seed are averaged, and count as one
  std::vector<std::string> crossed_seeds;  // of which the units are as many as one has (SeedUnits)
  int runs_a = 0;                          // that meet the conditions and did not fail
  int runs_b = 0;
  int unpaired_a = 0;  // of these, left out as the other side has no partner
  int unpaired_b = 0;
  int repeated_seeds = 0;  // gave what another one gave in every score: they do not count
  std::vector<MetricComparison> metrics;  // with at least one pair in which both are defined
  std::vector<std::string> undefined;     // in every pair on one side or the other
  // Of `--metric all`: no tests, as nobody would call either side better.
  std::vector<std::string> without_direction;
  std::vector<std::string> all_equal;  // both sides have one value in each pair
  int most_rows = 0;                   // of these, that so many pairs can tell apart at once
  int pairs_for_one = 0;               // that can tell apart one row, and all of them
  int pairs_for_all = 0;
};

// Throws InputError for a metric or axis that is not there, runs that make no pair, and runs that
// make several.
Comparison Compare(const SweepResults& a, const SweepResults& b, const CompareOptions& options);

std::string ComparisonJson(const Comparison& comparison, const std::string& a,
                           const std::string& b);

}  // namespace depthgrid
