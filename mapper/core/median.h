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

}  // namespace depthgrid
