// Spread in range of the returns of one surface, measured in the image itself. The nearest of
// hundreds of noisy returns lies about three sigma before its surface, so the nearest surface is
// the mean over a window of about six sigma; and sigma differs between sensors by a factor of a
// hundred and grows with the square of the range.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "mapper/core/depth_image.h"

namespace depthgrid {

class NoiseWindow {
 public:
  // Without an image: a Kinect's noise.
  NoiseWindow();
  // From second differences of inverse depth along image rows, which vanish on planes: a high
  // quantile of them for each class of depth.
  explicit NoiseWindow(const DepthImage& image) {
    Memory memory;
    *this = NoiseWindow(image, memory);
  }
  // The same with memory kept from frame to frame.
  static constexpr int kClasses = 32;
  using Memory = std::array<std::vector<float>, kClasses>;
  NoiseWindow(const DepthImage& image, Memory& differences);

  static constexpr double kWindowSigmas = 6.0;
  // Wider than this, the window would join a chair with the wall behind it. But it is never
  // narrower than the least number of sigmas: the mean would stay near the smallest sample
  // (docs/tried.md, "Where a depth camera's reach ends").
  static constexpr double kMaxWindowM = 0.4;
  static constexpr double kLeastSigmas = 5.0;
  // One standard deviation as a share of the window; a sixth less where it is capped.
  static constexpr float kSigmaShare = static_cast<float>(1.0 / kWindowSigmas);

  // Width of the window at a range.
  float At(float range_m) const {
    const double sigma_m = SigmaM(range_m);
    return static_cast<float>(std::max(
        std::clamp(kWindowSigmas * sigma_m, kMinWindowM, kMaxWindowM), kLeastSigmas * sigma_m));
  }

  // The same for many ranges.
  void At(std::span<const float> ranges_m, float* widths_m) const;

  // The mean over a window lies nearer to the surface than the window's centre: of one six sigma
  // wide .03 of the way is left, of w sigma w phi(w/2) / (2 Phi(w/2) - 1): .09 of 5. More where the
  // samples are few, as in the distance, where sigma is so large that the window is capped.
  static constexpr int kMeansOfCapped = 7;
  static bool IsCapped(float width_m) { return width_m >= static_cast<float>(kMaxWindowM); }
  static int MeansOf(float width_m) { return IsCapped(width_m) ? kMeansOfCapped : 1; }

  static constexpr double kClassM = 0.5;  // classes of depth are this wide, from 0

  // Lower edge of the farthest half-metre class of depth with enough samples (without depths of 32
  // m and more, which no depth camera measures); 0 if there is none.
  double farthest_m() const { return farthest_m_; }

  // Standard deviation of depth as estimated for a class of depth.
  double SigmaM(double z_m) const {
    // Linear between the centres of the classes.
    const double position = std::clamp(z_m / kClassM - 0.5, 0.0, kClasses - 1.0);
    const int below = std::min(static_cast<int>(position), kClasses - 2);
    const double share = position - below;
    const double* const inverse_sigma = &inverse_sigma_[static_cast<std::size_t>(below)];
    return z_m * z_m * ((1.0 - share) * inverse_sigma[0] + share * inverse_sigma[1]);
  }

 private:
  static constexpr double kMinWindowM = 0.01;

  std::array<double, kClasses> inverse_sigma_{};  // of 1/z, 1/m
  double farthest_m_ = 0.0;
};

}  // namespace depthgrid
