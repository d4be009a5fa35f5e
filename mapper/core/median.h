// Medians, for what outliers must not move.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "mapper/core/error.h"

namespace depthgrid {

// The standard deviation of a normal variable of mean 0, over the median of its magnitude.
constexpr double kSigmaOfMedian = 1.4826;

// The middle value by size; of an even number of values the upper of the two, no mean is taken.
inline double UpperMedian(std::vector<double> values) {
  Require(!values.empty(), "a median needs values");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace depthgrid
