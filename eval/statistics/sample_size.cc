#include "eval/statistics/sample_size.h"

#include <algorithm>
#include <cmath>

#include "eval/statistics/distributions.h"
#include "eval/statistics/wilcoxon.h"
#include "mapper/core/angle.h"
#include "mapper/core/error.h"

namespace depthgrid {

double PairedPower(int pairs, double effect_in_std, double level) {
  Require(pairs >= 2, "a t-test is of at least two pairs");
  const double degrees = pairs - 1.0;
  const double critical = StudentTQuantile(1.0 - 0.5 * level, degrees);
  const double noncentrality = std::abs(effect_in_std) * std::sqrt(static_cast<double>(pairs));
  return 1.0 - StudentTCdf(critical, degrees, noncentrality) +
         StudentTCdf(-critical, degrees, noncentrality);
}

std::optional<int> SeedsNeeded(double effect, double std_of_differences, const TestPlan& plan) {
  Require(effect != 0.0, "an effect is not zero");
  Require(std_of_differences >= 0.0, "a standard deviation is not negative");
  Require(plan.power > plan.level && plan.power < 1.0, "a power is between the level and 1");
  constexpr int kLeast = 2;
  constexpr int kMost = 1000000;
  if (std_of_differences == 0.0) return kLeast;
  const double ratio = std::abs(effect) / std_of_differences;
  const auto enough = [&](int pairs) {
    return PairedPower(pairs, ratio, plan.level) >= plan.power;
  };
  int low = kLeast - 1;  // too few
  int high = kLeast;
  while (!enough(high)) {
    if (high >= kMost) return std::nullopt;
    low = high;
    high = std::min(2 * high, kMost);
  }
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

std::optional<int> SeedsNeededByRanks(double effect, double std_of_differences,
                                      const TestPlan& plan) {
  const auto by_t = SeedsNeeded(effect, std_of_differences, plan);
  if (!by_t) return std::nullopt;
  const double efficiency = 3.0 / kPi;
  int pairs = static_cast<int>(std::ceil(*by_t / efficiency));
  while (LeastWilcoxonP(pairs) >= plan.level) ++pairs;
  return pairs;
}

}  // namespace depthgrid
