// The Wilcoxon signed-rank test: are paired differences symmetric about zero?
#pragma once

#include <vector>

#include "eval/statistics/paired_differences.h"

namespace depthgrid {

enum class WilcoxonMethod {
  kAuto,   // exact up to kWilcoxonExactPairs differences that are not zero
  kExact,  // over all 2^n signs of the ranks, with ties
  kNormal  // the normal approximation, corrected for ties, without a continuity correction (SciPy)
};

// SciPy's limit (scipy.stats.wilcoxon, mode `auto`).
constexpr int kWilcoxonExactPairs = 50;

struct WilcoxonResult {
  int pairs = 0;  // differences that are not zero: only these are ranked (Wilcoxon 1945)
  int zeros = 0;  // those that are
  // The smaller of W+ and W-, the sums of the ranks of the positive and of the negative
  // differences; tied sizes share their mean rank.
  double statistic = 0.0;
  double p_value = 1.0;  // two-sided; 1 when all differences are zero
  bool exact = true;
  // (W+ - W-) / (W+ + W-): 1 when every difference is positive, 0 when they balance.
  double rank_biserial = 0.0;
};

// The smallest possible p-value of `pairs` differences: all of one sign, 2 of 2^n.
double LeastWilcoxonP(int pairs);

// Only differences that are exactly zero or exactly equal in size count as zeros and ties.
WilcoxonResult Wilcoxon(const std::vector<double>& differences,
                        WilcoxonMethod method = WilcoxonMethod::kAuto);
// Sizes that differ only by rounding are ties. A group of ties extends by the rounding error from
// its smallest size and no further, so that the groups are disjoint.
WilcoxonResult WilcoxonOfPairs(const PairedDifferences& differences);

}  // namespace depthgrid
