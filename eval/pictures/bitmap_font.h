// A 5x7 dot-matrix font, the shapes of character displays.
#pragma once

#include <array>
#include <cstdint>

namespace depthgrid {

constexpr int kGlyphWidthPx = 5;
constexpr int kGlyphHeightPx = 7;

// Columns from left to right; bit 0 is the top row. '?' stands in for what is not printable ASCII.
std::array<std::uint8_t, kGlyphWidthPx> GlyphOf(char character);

}  // namespace depthgrid
