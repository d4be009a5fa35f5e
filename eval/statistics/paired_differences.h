// Differences of paired scores, with those that are only rounding errors set to 0.
#pragma once

#include <vector>

namespace depthgrid {

// Relative tolerance, of the larger score: scores that differ by less are equal, and so are
// differences. Doubles have relative errors of 1e-16 and means of many about 1e-14, so scores that
// should be equal (a share of the same plans, a distance between the same cells) differ by that
// much. No score is accurate to 1e-9.
constexpr double kRoundingShare = 1e-9;

struct PairedDifferences {
  std::vector<double> values;    // b - a; 0 where both are equal up to rounding
  std::vector<double> rounding;  // possible error of each
};

// `a` and `b` have the same length. The tolerance depends on each pair alone, so that one run with
// huge errors does not affect the other differences.
PairedDifferences DifferencesOf(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace depthgrid
