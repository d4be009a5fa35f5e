// The sensor's actual errors, estimated from the residuals of surfels that should coincide
// (docs/math.md, "Errors that beams share").
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "mapper/core/median.h"

namespace depthgrid {

// A histogram of residuals in units of the sigma they were expected to have.
class Misfit {
 public:
  void Add(double sigmas) {
    const auto bin = static_cast<std::size_t>(std::abs(sigmas) * kBinsPerSigma);
    ++counts_[std::min(bin, kBins - 1)];
    ++count_;
  }
  // Variance over expected variance, by the median, which is robust to wrong associations. At least
  // 1: a better fit than expected raises no confidence.
  double VarianceFactor() const {
    std::uint32_t below = 0;
    std::size_t bin = 0;
    while (bin + 1 < kBins && 2 * (below + counts_[bin]) < count_) below += counts_[bin++];
    const double sigma = kSigmaOfMedian * (static_cast<double>(bin) + 0.5) / kBinsPerSigma;
    return std::max(1.0, sigma * sigma);
  }

 private:
  static constexpr double kBinsPerSigma = 10.0;
  static constexpr std::size_t kBins = 4000;  // 400 sigma

  std::array<std::uint32_t, kBins> counts_{};
  std::uint32_t count_ = 0;
};

}  // namespace depthgrid
