// Number of seeds needed to detect a difference.
#pragma once

#include <optional>

namespace depthgrid {

struct TestPlan {
  double level = 0.05;  // two-sided probability of a false positive
  double power = 0.8;   // probability of detecting a true difference
};

// The probability that a paired t-test over `pairs` seeds detects a true mean difference of
// `effect_in_std` standard deviations of the differences.
double PairedPower(int pairs, double effect_in_std, double level = TestPlan{}.level);

// The smallest number of seeds at which a paired t-test has the power; empty above a million.
std::optional<int> SeedsNeeded(double effect, double std_of_differences, const TestPlan& plan = {});

// For the signed-rank test: the above divided by its asymptotic relative efficiency on normal
// differences, 3 / pi (Lehmann 1975), rounded up; at least enough that its p-value can be below the
// level.
std::optional<int> SeedsNeededByRanks(double effect, double std_of_differences,
                                      const TestPlan& plan = {});

}  // namespace depthgrid
