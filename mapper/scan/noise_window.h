// How far apart in range the returns of one surface can be, measured in the image itself. The
// nearest of hundreds of noisy returns lies about three sigma before its surface, so the nearest
// surface is the mean over a window of about six sigma; and sigma differs between sensors by a
// factor of a hundred and grows with the square of the range.
#pragma once

#include <array>
#include <vector>

#include "mapper/core/depth_image.h"

namespace depthgrid {

class NoiseWindow {
 public:
  // From second differences of inverse depth along image rows, which vanish on planes: a high
  // quantile of them for each class of depth.
  explicit NoiseWindow(const DepthImage& image) {
    Memory memory;
    *this = NoiseWindow(image, memory);
  }
  // The same with memory kept from frame to frame.
  static constexpr int kClasses = 16;
  using Memory = std::array<std::vector<float>, kClasses>;
  NoiseWindow(const DepthImage& image, Memory& memory);

  // Width of the window at a range.
  float At(float range_m) const;

  // Standard deviation of depth as estimated for a class of depth, for tests.
  double SigmaM(double z_m) const;

 private:
  std::array<double, kClasses> inverse_sigma_{};  // of 1/z, 1/m
};

}  // namespace depthgrid
