// How noisy the ranges are, learned from the scans themselves (docs/math.md, "Surfels").
#pragma once

#include <array>
#include <cstdint>

#include "mapper/core/scan.h"

namespace depthgrid {

// The relative standard deviation of a range as a function of the range. Along a straight wall the
// inverse range is A cos(bearing) + B sin(bearing), whose second difference
// u(-1) - 2 cos(step) u(0) + u(+1) vanishes; what is left of it is noise of variance 6 sigma_u^2.
// The median makes corners and jumps harmless.
class RangeNoise {
 public:
  RangeNoise();
  void Add(const Scan& scan);
  // sigma(r) / r.
  double RelativeSigma(double range_m) const;

 private:
  static constexpr int kRangeBins = 24;   // two an octave from 0.25 m: up to 1 km
  static constexpr int kValueBins = 160;  // eight an octave from 2^-19: up to 2

  void Refresh();

  std::array<std::array<std::uint32_t, kValueBins>, kRangeBins> histogram_{};
  std::array<std::uint32_t, kRangeBins> count_{};
  std::array<double, kRangeBins> relative_sigma_{};
  std::int64_t scans_ = 0;
};

}  // namespace depthgrid
