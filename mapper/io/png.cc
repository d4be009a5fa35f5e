#include "mapper/io/png.h"

#include <algorithm>
#include <cmath>

#include "mapper/io/file.h"
#include "mapper/io/png_codec.h"

namespace depthgrid {
namespace {

using internal::DecodePng;
using internal::EncodePng;
using internal::PngKind;
using internal::PngPixels;

constexpr std::uint16_t kFarthestUnits = 65534;
constexpr std::size_t kDepthValues = 65536;

std::vector<float> DepthTable(const DepthPngFormat& format) {
  std::vector<float> table(kDepthValues);
  for (std::size_t units = 0; units < kDepthValues; ++units) {
    table[units] = static_cast<float>(static_cast<double>(units) / format.scale_per_m);
  }
  table[0] = kInvalidDepth;
  for (const std::uint16_t units : format.invalid_units) table[units] = kInvalidDepth;
  return table;
}

}  // namespace

std::uint16_t DepthUnits(float z_m, double scale_per_m) {
  if (!(z_m > 0.0F)) return 0;
  const double units = std::floor(static_cast<double>(z_m) * scale_per_m + 0.5);
  return static_cast<std::uint16_t>(std::clamp(units, 1.0, static_cast<double>(kFarthestUnits)));
}

DepthImage QuantiseDepth(const DepthImage& image, const DepthPngFormat& format) {
  const std::vector<float> depth_of_units = DepthTable(format);
  DepthImage quantised(image.width_px, image.height_px);
  std::transform(image.z_m.begin(), image.z_m.end(), quantised.z_m.begin(),
                 [&](float z_m) { return depth_of_units[DepthUnits(z_m, format.scale_per_m)]; });
  return quantised;
}

std::string EncodeDepthPng(const DepthImage& image, double scale_per_m) {
  PngPixels pixels{PngKind::kGrey16, image.width_px, image.height_px, {}};
  pixels.bytes.reserve(2 * image.z_m.size());
  for (const float z_m : image.z_m) {
    const std::uint16_t units = DepthUnits(z_m, scale_per_m);
    pixels.bytes.push_back(static_cast<std::uint8_t>(units >> 8U));
    pixels.bytes.push_back(static_cast<std::uint8_t>(units & 0xFFU));
  }
  return EncodePng(pixels);
}

DepthImage DecodeDepthPng(std::string_view png, const DepthPngFormat& format,
                          const std::string& place) {
  const PngPixels pixels = DecodePng(png, PngKind::kGrey16, place);
  const std::vector<float> depth_of_units = DepthTable(format);
  DepthImage image(pixels.width_px, pixels.height_px);
  for (std::size_t i = 0; i < image.z_m.size(); ++i) {
    image.z_m[i] = depth_of_units[pixels.bytes[2 * i] << 8U | pixels.bytes[2 * i + 1]];
  }
  return image;
}

DepthImage ReadDepthPng(const std::string& path, const DepthPngFormat& format) {
  return DecodeDepthPng(ReadFile(path), format, path);
}

void WriteDepthPng(const std::string& path, const DepthImage& image, double scale_per_m) {
  WriteFile(path, EncodeDepthPng(image, scale_per_m));
}

std::string EncodeRgbPng(const RgbImage& image) {
  return EncodePng({PngKind::kRgb8, image.width_px, image.height_px, image.rgb});
}

RgbImage DecodeRgbPng(std::string_view png, const std::string& place) {
  PngPixels pixels = DecodePng(png, PngKind::kRgb8, place);
  RgbImage image;
  image.width_px = pixels.width_px;
  image.height_px = pixels.height_px;
  image.rgb = std::move(pixels.bytes);
  return image;
}

void WriteRgbPng(const std::string& path, const RgbImage& image) {
  WriteFile(path, EncodeRgbPng(image));
}

RgbaImage DecodeRgbaPng(std::string_view png, const std::string& place) {
  PngPixels pixels = DecodePng(png, PngKind::kRgba8, place);
  return {pixels.width_px, pixels.height_px, std::move(pixels.bytes)};
}

std::string EncodeRgbaPng(const RgbaImage& image) {
  return EncodePng({PngKind::kRgba8, image.width_px, image.height_px, image.rgba});
}

}  // namespace depthgrid
