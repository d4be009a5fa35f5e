// A colour image: 8 bit a channel, sRGB, row-major, row 0 at the top.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace depthgrid {

struct RgbImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;  // 3 * width_px * height_px: red, green, blue of each pixel

  RgbImage() = default;
  RgbImage(int width, int height)
      : width_px(width),
        height_px(height),
        rgb(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0) {}

  // The three bytes of a pixel.
  const std::uint8_t* At(int u_px, int v_px) const { return rgb.data() + Offset(u_px, v_px); }
  std::uint8_t* At(int u_px, int v_px) { return rgb.data() + Offset(u_px, v_px); }

  bool operator==(const RgbImage&) const = default;

 private:
  std::size_t Offset(int u_px, int v_px) const {
    return 3 * (static_cast<std::size_t>(v_px) * static_cast<std::size_t>(width_px) +
                static_cast<std::size_t>(u_px));
  }
};

}  // namespace depthgrid
