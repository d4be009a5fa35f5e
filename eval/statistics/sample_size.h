// How many seeds are enough to see a difference that is there.
#pragma once

#include <optional>

namespace depthgrid {

struct TestPlan {
  double level = 0.05;  // two-sided chance of seeing what is not there
  double power = 0.8;   // chance of seeing what is there
};

// The chance that a paired t-test over `pairs` seeds sees a true mean difference of
// `effect_in_std` standard deviations of the differences.
double PairedPower(int pairs, double effect_in_std, double level = TestPlan{}.level);

// The smallest number of seeds at which a paired t-test reaches the power; empty beyond a million.
std::optional<int> SeedsNeeded(double effect, double std_of_differences, const TestPlan& plan = {});

// For the signed-rank test: more by its asymptotic relative efficiency on normal differences,
// pi / 3 (Lehmann 1975), rounded up; and so many that its p-value can fall below the level at all.
std::optional<int> SeedsNeededByRanks(double effect, double std_of_differences,
                                      const TestPlan& plan = {});

}  // namespace depthgrid
