// Medians, for what outliers must not move.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "mapper/core/error.h"

namespace depthgrid {

// The standard deviation of a normal variable of mean 0, over the median of its magnitude.
constexpr double kSigmaOfMedian = 1.4826;

// The middle value by size; of an even number of values the upper of the two, no mean is taken.
// `value` tells that of an item. Reorders the items, and takes no memory.
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

// Half of the weight lies below it and half above; where nothing has weight all count alike.
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
