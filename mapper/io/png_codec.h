// libpng behind two calls on raw rows. Private to mapper/io/png.cc.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid::internal {

enum class PngKind { kGrey8, kGrey16, kRgb8, kRgba8 };

struct PngPixels {
  PngKind kind = PngKind::kGrey8;
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> bytes;  // rows top first, 16-bit samples in big-endian order
};

// Bytes of one pixel.
int PixelBytes(PngKind kind);

// Converts to 8-bit colour when `wanted` is kRgb8 or kRgba8; the grey kinds must be what the file
// holds. Throws InputError.
PngPixels DecodePng(std::string_view png, PngKind wanted, const std::string& place);

std::string EncodePng(const PngPixels& pixels);

}  // namespace depthgrid::internal
