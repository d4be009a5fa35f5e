// Range noise, learned from the scans themselves (docs/math.md, "Surfels").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "mapper/core/scan.h"

namespace depthgrid {

// The relative standard deviation of a range as a function of the range. Along a straight wall the
// inverse range is A cos(bearing) + B sin(bearing), whose second difference u(-1) - 2 cos(step)
// u(0) + u(+1) vanishes but for noise of variance 6 sigma_u^2. The median makes it robust to
// corners and jumps. Errors that neighbouring beams share vanish too, so the same is done with
// beams farther apart, up to a spacing at which errors are independent.
class RangeNoise {
 public:
  // `skips_alike`: whether stride() may exceed 1.
  explicit RangeNoise(bool skips_alike = true);
  void Add(const Scan& scan);
  // sigma(r) / r, estimated from beams stride() apart.
  double RelativeSigma(double range_m) const;
  // Whether it tells what the sensor's reach cut off: not while little was seen, and that near the
  // reach, since sigma is a cheap scanner's until it is learnt.
  bool TellsCutoff() const { return by_stride_[chosen_].tells_cutoff; }
  // Spacing of beams from which their errors are independent: 1, 2, 4, 8, 16 or 32.
  int stride() const { return 1 << chosen_; }

  static constexpr int kValueBins = 160;  // of second differences: eight an octave from 2^-19 to 2

 private:
  static constexpr int kRangeBins = 24;  // two an octave from 0.25 m: up to 1 km
  static constexpr int kStrides = 6;     // 1 to 32

  // Second differences, by range and by size.
  struct Samples {
    std::array<std::array<std::uint32_t, kValueBins>, kRangeBins> histogram{};
    std::array<std::uint32_t, kRangeBins> count{};

    std::uint64_t Total() const;
  };
  // Those of beams one stride apart, and what they show.
  struct Differences {
    Samples whole;     // well within the sensor's reach
    Samples near_cut;  // so near the reach that the largest may be missing
    std::array<double, kRangeBins> shown_sigma{};     // relative, by the median; known bins only
    std::array<double, kRangeBins> relative_sigma{};  // at least that of the best sensor; all bins
    bool tells_cutoff = false;

    void Add(const Scan& scan, std::size_t stride);
    // `are_independent`: the beams err independently, and what else they show is left out.
    void Refresh(bool are_independent);
    bool Knows(std::size_t range_bin) const;
    // Learns `factor` times what the bins with at least `least` samples show; false where there is
    // none.
    bool LearnFrom(const Samples& samples, std::uint32_t least, double factor);

    bool independent = false;
  };
  bool AreAlike(std::size_t power) const;
  bool ShowNoise(std::size_t power) const;

  std::array<Differences, kStrides> by_stride_{};  // index k: stride 2^k
  std::size_t chosen_ = 0;                         // stride() is 2^chosen_
  bool skips_alike_;
  std::int64_t scans_ = 0;
};

}  // namespace depthgrid
