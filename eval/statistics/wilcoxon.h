// The Wilcoxon signed-rank test: are paired differences symmetric about zero?
#pragma once

#include <vector>

#include "eval/statistics/paired_differences.h"

namespace depthgrid {

enum class WilcoxonMethod {
  kAuto,   // exact up to kWilcoxonExactPairs differences that are not zero
  kExact,  // all 2^n signs of the ranks at hand, ties included
  kNormal  // the normal approximation, corrected for ties, without a continuity correction (SciPy)
};

// SciPy's limit (scipy.stats.wilcoxon, mode `auto`).
constexpr int kWilcoxonExactPairs = 50;

struct WilcoxonResult {
  int pairs = 0;           // differences that are not zero: only these are ranked (Wilcoxon 1945)
  int zeros = 0;           // those that are
  double rank_sum = 0.0;   // of the positive differences, W+; tied sizes share their mean rank
  double statistic = 0.0;  // the smaller of W+ and W-
  double p_value = 1.0;    // two-sided; 1 when all differences are zero
  bool exact = true;
  // (W+ - W-) / (W+ + W-): 1 when every difference is positive, 0 when they balance.
  double rank_biserial = 0.0;
};

// The smallest p-value that so many differences can give: all of one sign, 2 of 2^n.
double LeastWilcoxonP(int pairs);

// Differences as they are: those that are exactly zero or equally large are zeros and ties.
WilcoxonResult Wilcoxon(const std::vector<double>& differences,
                        WilcoxonMethod method = WilcoxonMethod::kAuto);
// Sizes that differ by no more than rounding are ties. So that being tied is one thing for all, a
// group of ties reaches from its smallest size as far as rounding does, and no further.
WilcoxonResult WilcoxonOfPairs(const PairedDifferences& differences);

}  // namespace depthgrid
