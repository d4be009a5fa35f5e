// Portable grey maps: P2 (text) and P5 (binary), 8 or 16 bits, comments anywhere in the header, one
// or many header lines.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mapper/io/png.h"

namespace depthgrid {

struct PgmImage {
  int width_px = 0;
  int height_px = 0;
  int max_value = 255;
  std::vector<std::uint16_t> values;  // width_px * height_px, row 0 at the top

  bool operator==(const PgmImage&) const = default;
};

bool IsPgm(std::string_view bytes);
// Throws InputError unless it is a complete PGM image, followed at most by white space or another
// image, which is ignored.
PgmImage DecodePgm(std::string_view bytes, const std::string& place);
// P5 with one line each for magic, size and maximum.
std::string EncodePgm(const GreyImage& image);

}  // namespace depthgrid
