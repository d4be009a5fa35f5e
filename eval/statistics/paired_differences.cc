#include "eval/statistics/paired_differences.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mapper/core/error.h"

namespace depthgrid {

PairedDifferences DifferencesOf(const std::vector<double>& a, const std::vector<double>& b) {
  Require(a.size() == b.size(), "pairs are of as many values on both sides");
  PairedDifferences differences;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double rounding = kRoundingShare * std::max(std::abs(a[i]), std::abs(b[i]));
    const double value = b[i] - a[i];
    differences.values.push_back(std::abs(value) <= rounding ? 0.0 : value);
    differences.rounding.push_back(rounding);
  }
  return differences;
}

}  // namespace depthgrid
