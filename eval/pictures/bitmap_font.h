// A 5x7 dot-matrix font, as on character displays.
#pragma once

#include <array>
#include <cstdint>

namespace depthgrid {

constexpr int kGlyphWidthPx = 5;
constexpr int kGlyphHeightPx = 7;

// Columns from left to right; bit 0 is the top row. '?' replaces characters that are not printable
// ASCII.
std::array<std::uint8_t, kGlyphWidthPx> GlyphOf(char character);

}  // namespace depthgrid
