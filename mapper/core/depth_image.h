// A depth image: z-depth in metres along the optical axis (not ray length), row-major, row 0 at the
// top.
#pragma once

#include <cstddef>
#include <vector>

namespace depthgrid {

// The value of a pixel the sensor could not measure; the mapper treats NaN and negative values the
// same. It is neither "too near" nor "too far": those are finite positive values outside the
// mapper's range, which carry information about free space (docs/conventions.md).
constexpr float kInvalidDepth = 0.0F;

struct DepthImage {
  int width_px = 0;
  int height_px = 0;
  // width_px * height_px: kInvalidDepth or positive; infinity counts as too far.
  std::vector<float> z_m;

  DepthImage() = default;
  DepthImage(int width, int height)
      : width_px(width),
        height_px(height),
        z_m(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kInvalidDepth) {}

  const float* Row(int v_px) const { return z_m.data() + Offset(v_px); }
  float* Row(int v_px) { return z_m.data() + Offset(v_px); }
  float At(int u_px, int v_px) const { return Row(v_px)[u_px]; }

 private:
  std::size_t Offset(int v_px) const {
    return static_cast<std::size_t>(v_px) * static_cast<std::size_t>(width_px);
  }
};

}  // namespace depthgrid
