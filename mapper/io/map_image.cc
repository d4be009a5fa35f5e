#include "mapper/io/map_image.h"

#include <fmt/format.h>

#include <cmath>

#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/pgm.h"
#include "mapper/io/png.h"

namespace depthgrid::internal {
namespace {

constexpr double kWhite = 255.0;
constexpr double kFullPercent = 100.0;
// Values written by map_saver; 205 is between the default thresholds.
constexpr std::uint8_t kOccupiedPixel = 0;
constexpr std::uint8_t kFreePixel = 254;
constexpr std::uint8_t kUnknownPixel = 205;
constexpr std::uint8_t kUnknownRawPixel = 255;

ShadeImage ShadesOfPgm(const PgmImage& pgm) {
  ShadeImage image{pgm.width_px, pgm.height_px, {}, std::vector<bool>(pgm.values.size(), true)};
  image.shade.reserve(pgm.values.size());
  for (const auto value : pgm.values) {
    image.shade.push_back(static_cast<double>(value) / pgm.max_value);
  }
  return image;
}

ShadeImage ShadesOfPng(const RgbaImage& png, MapMode mode) {
  const std::size_t pixels = png.rgba.size() / 4;
  ShadeImage image{png.width_px, png.height_px, {}, {}};
  bool has_alpha = false;
  for (std::size_t i = 0; i < pixels; ++i) {
    image.opaque.push_back(png.rgba[4 * i + 3] == 255);
    has_alpha = has_alpha || !image.opaque.back();
  }
  // Nav2 averages the channels, in trinary mode including alpha.
  const int channels = has_alpha && mode == MapMode::kTrinary ? 4 : 3;
  for (std::size_t i = 0; i < pixels; ++i) {
    int sum = 0;
    for (int c = 0; c < channels; ++c) sum += png.rgba[4 * i + static_cast<std::size_t>(c)];
    image.shade.push_back(sum / (channels * kWhite));
  }
  return image;
}

// Limits the image's size: each pixel needs about twenty bytes while reading but few in a
// compressed file.
void RequireDrawable(int width_px, int height_px, const std::string& path) {
  const GridGeometry geometry{1.0, {}, width_px, height_px};
  if (geometry.size() <= kMaxMapCells) return;
  throw InputError(path, fmt::format("has {} x {} pixels, a map may have {}", width_px, height_px,
                                     kMaxMapCells));
}

// The pixel value nearest to `value` that is read back as the same state; plain rounding might
// cross a threshold.
std::uint8_t PixelOfState(float occupied_prob, double value, double whole, const ShadeRule& rule) {
  const double nearest = std::round(value);
  const double second = value < nearest ? nearest - 1.0 : nearest + 1.0;
  const auto keeps_state = [&](double pixel) {
    return StateOf(OccupiedProb(pixel / kWhite, true, rule)) == StateOf(occupied_prob);
  };
  const bool takes_second = second >= 0.0 && second <= whole && !keeps_state(nearest);
  return static_cast<std::uint8_t>(takes_second ? second : nearest);
}

std::uint8_t PixelOf(float occupied_prob, MapMode mode) {
  const ShadeRule rule{mode, false, WrittenThresholds(mode)};
  if (mode == MapMode::kRaw) {
    return std::isnan(occupied_prob)
               ? kUnknownRawPixel
               : PixelOfState(occupied_prob, occupied_prob * kFullPercent, kFullPercent, rule);
  }
  if (mode == MapMode::kScale) {
    return std::isnan(occupied_prob)
               ? kUnknownPixel
               : PixelOfState(occupied_prob, (1.0 - occupied_prob) * kWhite, kWhite, rule);
  }
  switch (StateOf(occupied_prob)) {
    case CellState::kOccupied:
      return kOccupiedPixel;
    case CellState::kFree:
      return kFreePixel;
    case CellState::kUnknown:
      break;
  }
  return kUnknownPixel;
}

}  // namespace

// Nav2 maps the range between the thresholds to probabilities, so 1 and 0 preserve all of them.
StateThresholds WrittenThresholds(MapMode mode) {
  return mode == MapMode::kScale ? StateThresholds{1.0, 0.0} : StateThresholds{};
}

ShadeImage ReadShades(const std::string& path, MapMode mode) {
  const std::string bytes = ReadFile(path);
  if (bytes.empty()) throw InputError(path, "is empty, must be a PGM or PNG image");
  if (IsPgm(bytes)) {
    const PgmImage pgm = DecodePgm(bytes, path);
    RequireDrawable(pgm.width_px, pgm.height_px, path);
    return ShadesOfPgm(pgm);
  }
  if (bytes.starts_with("\x89PNG")) return ShadesOfPng(DecodeRgbaPng(bytes, path), mode);
  throw InputError(path, "is neither a PGM nor a PNG image");
}

float OccupiedProb(double shade, bool opaque, const ShadeRule& rule) {
  if (rule.mode == MapMode::kRaw) {
    const double percent = std::round(shade * kWhite);
    return percent <= kFullPercent ? static_cast<float>(percent / kFullPercent) : kUnknownProb;
  }
  const double p = rule.negate ? shade : 1.0 - shade;
  const auto& [occupied, free] = rule.thresholds;
  if (rule.mode == MapMode::kScale && !opaque) return kUnknownProb;
  if (p > occupied) return 1.0F;
  if (p < free) return 0.0F;
  if (rule.mode == MapMode::kTrinary) return kUnknownProb;
  return static_cast<float>((p - free) / (occupied - free));
}

std::string EncodeMapImage(const OccupancyMap& map, MapMode mode) {
  const auto& [resolution_m, min_cell, width, height] = map.geometry;
  GreyImage grey{width, height, {}};
  RgbaImage rgba{width, height, {}};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const float prob = map.At({min_cell.x + u, min_cell.y + height - 1 - v});
      const std::uint8_t pixel = PixelOf(prob, mode);
      grey.grey.push_back(pixel);
      const std::uint8_t alpha = std::isnan(prob) ? 0 : 255;
      if (mode == MapMode::kScale) rgba.rgba.insert(rgba.rgba.end(), {pixel, pixel, pixel, alpha});
    }
  }
  return mode == MapMode::kScale ? EncodeRgbaPng(rgba) : EncodePgm(grey);
}

}  // namespace depthgrid::internal
