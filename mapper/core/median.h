// Medians, for estimates robust to outliers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "mapper/core/error.h"

namespace depthgrid {

// Ratio of the standard deviation of a zero-mean normal variable to the median of its magnitude.
constexpr double kSigmaOfMedian = 1.4826;

// The median; of an even number of values the upper of the middle two, not their mean. `value` maps
// an item to its value. Reorders the items and allocates nothing.
template <typename Item, typename Value = std::identity>
double UpperMedianAmong(std::span<Item> items, const Value& value = {}) {
  Require(!items.empty(), "a median needs values");
  const auto middle = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
  std::nth_element(items.begin(), middle, items.end(),
                   [&](const Item& a, const Item& b) { return value(a) < value(b); });
  return value(*middle);
}

inline double UpperMedian(std::vector<double> values) {
  return UpperMedianAmong(std::span<double>(values));
}

struct Weighed {
  double value = 0.0;
  double weight = 0.0;
};

// The weighted median; with no positive weight all values count alike.
inline double WeighedMedian(std::vector<Weighed> values) {
  double all = 0.0;
  for (const Weighed& v : values) all += v.weight;
  if (all <= 0.0) {
    for (Weighed& v : values) all += v.weight = 1.0;
  }
  std::stable_sort(values.begin(), values.end(),
                   [](const Weighed& a, const Weighed& b) { return a.value < b.value; });
  double below = 0.0;
  for (const Weighed& v : values) {
    below += v.weight;
    if (below > 0.5 * all) return v.value;
  }
  return values.back().value;
}

}  // namespace depthgrid
