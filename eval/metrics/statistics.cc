#include "eval/metrics/statistics.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/error.h"

namespace depthgrid {

Statistics Summarise(const std::vector<double>& values) {
  Require(!values.empty(), "statistics are of at least one value");
  Statistics s;
  s.count = static_cast<int>(values.size());
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double v : values) {
    sum += v;
    s.sse += v * v;
  }
  s.mean = sum / n;
  s.rmse = std::sqrt(s.sse / n);
  double squared_deviations = 0.0;
  for (const double v : values) squared_deviations += (v - s.mean) * (v - s.mean);
  s.std = std::sqrt(squared_deviations / n);
  s.median = Percentile(values, 0.5);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  s.min = *low;
  s.max = *high;
  return s;
}

double Percentile(std::vector<double> values, double fraction) {
  Require(!values.empty(), "a percentile is of at least one value");
  const double position = fraction * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(position);
  std::nth_element(values.begin(), below, values.end());
  if (below + 1 == values.end()) return *below;
  const double above = *std::min_element(below + 1, values.end());
  return *below + (position - std::floor(position)) * (above - *below);
}

}  // namespace depthgrid
