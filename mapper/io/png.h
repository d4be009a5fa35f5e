// PNG files: depth images (16-bit grey), colour images and 8-bit grey images. The same image gives
// the same bytes. Reading throws InputError unless the file is a complete, intact PNG of the wanted
// kind.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/core/rgb_image.h"

namespace depthgrid {

struct GreyImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> grey;  // width_px * height_px, row 0 at the top

  bool operator==(const GreyImage&) const = default;
};

// How depth is stored in 16 bits.
struct DepthPngFormat {
  double scale_per_m = 5000.0;  // units per metre (TUM RGB-D; millimetre data has 1000)
  // Values that mean "no measurement", besides 0. 65535 is used by 7-Scenes, and is a saturated
  // value in other data.
  std::vector<std::uint16_t> invalid_units = {65535};
};

// Depth in units. A positive depth never becomes 0 (too near is not invalid), and beyond the range
// it becomes 65534 (too far is not invalid either; 13.1 m at 5000 per metre).
std::uint16_t DepthUnits(float z_m, double scale_per_m);
// The image as it will be read back.
DepthImage QuantiseDepth(const DepthImage& image, const DepthPngFormat& format = {});

std::string EncodeDepthPng(const DepthImage& image, double scale_per_m);
DepthImage DecodeDepthPng(std::string_view png, const DepthPngFormat& format,
                          const std::string& place);
DepthImage ReadDepthPng(const std::string& path, const DepthPngFormat& format = {});
void WriteDepthPng(const std::string& path, const DepthImage& image, double scale_per_m = 5000.0);

// Colour: grey, palette, 16-bit and transparent images are converted.
std::string EncodeRgbPng(const RgbImage& image);
RgbImage DecodeRgbPng(std::string_view png, const std::string& place);
void WriteRgbPng(const std::string& path, const RgbImage& image);

// Any PNG as 8-bit red, green, blue, alpha, for files in which transparency has a meaning.
struct RgbaImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgba;
};
RgbaImage DecodeRgbaPng(std::string_view png, const std::string& place);
std::string EncodeRgbaPng(const RgbaImage& image);

}  // namespace depthgrid
