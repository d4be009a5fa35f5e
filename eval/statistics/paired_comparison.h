// Compares two settings over the same seeds: which is better, by how much, and how significantly.
#pragma once

#include <optional>
#include <vector>

#include "eval/statistics/resamples.h"
#include "eval/statistics/wilcoxon.h"

namespace depthgrid {

enum class Better { kLower, kHigher, kNeither };

struct PairedComparison {
  int pairs = 0;
  double mean_a = 0.0;
  double mean_b = 0.0;
  double mean_difference = 0.0;                     // b - a
  double median_difference = 0.0;                   // b - a
  double std_difference = 0.0;                      // sample standard deviation; 0 for one pair
  std::optional<ConfidenceInterval> mean_interval;  // of the mean difference; empty for one pair
  int a_wins = 0;  // pairs in which a is better; 0 for Better::kNeither
  int b_wins = 0;
  WilcoxonResult wilcoxon;  // of b - a
};

// a[i] and b[i] have the same seed (and whatever else the pair shares); at least one pair. Values
// that differ only by rounding are equal, and neither wins.
PairedComparison ComparePaired(const std::vector<double>& a, const std::vector<double>& b,
                               Better better, const Resamples& resamples);

}  // namespace depthgrid
