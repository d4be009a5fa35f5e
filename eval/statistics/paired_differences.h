// Differences of scores that make pairs, without what rounding leaves of equal ones.
#pragma once

#include <vector>

namespace depthgrid {

// Of the larger score: scores that differ by less are the same, and differences that do are equally
// large. Doubles err by 1e-16 of themselves and means of many by some 1e-14, so equal scores (a
// share of the same plans, a distance between the same cells) come out that far apart; nothing is
// measured to 1e-9 of itself.
constexpr double kRoundingShare = 1e-9;

struct PairedDifferences {
  std::vector<double> values;    // b - a; 0 where both are the same but for rounding
  std::vector<double> rounding;  // how far each may be off
};

// As many on both sides. Sizes are those of each pair: one run that went far astray leaves the
// differences of the others as they are.
PairedDifferences DifferencesOf(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace depthgrid
