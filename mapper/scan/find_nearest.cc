#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "mapper/scan/bearing_returns.h"

namespace depthgrid {
namespace {

float MeanWithin(std::span<const float> samples, float low, float high, float otherwise) {
  float sum = 0.0F;
  float count = 0.0F;
  for (const float sample : samples) {
    if (sample >= low && sample <= high) {
      sum += sample;
      count += 1.0F;
    }
  }
  return count > 0.0F ? sum / count : otherwise;
}

// Ranges are not negative, so their bits order as they do; and integers vectorise without ado. The
// differences of smaller ones wrap round and are larger than any other.
std::uint32_t SmallestFrom(std::span<const float> samples, std::uint32_t from) {
  std::uint32_t least = std::numeric_limits<std::uint32_t>::max() - from;
  for (const float sample : samples) {
    least = std::min(least, std::bit_cast<std::uint32_t>(sample) - from);
  }
  return from + least;
}

std::size_t CountOf(std::span<const float> samples, float wanted) {
  std::uint32_t count = 0;
  for (const float sample : samples) count += sample == wanted ? 1 : 0;
  return count;
}

}  // namespace

RowRange RowsOf(const BearingLine& line, const ReturnLimits& limits) {
  return {std::max(line.first_row, limits.first_row), std::min(line.last_row, limits.last_row)};
}

float SampleAt(const DepthImage& image, const BearingLine& line, const ReturnLimits& limits,
               int v) {
  const auto row = static_cast<float>(v);
  const float u = std::min(std::max(line.u0 + line.u1 * row, 0.0F), LastColumn(image.width_px));
  const int column = static_cast<int>(u);
  const float share = u - static_cast<float>(column);
  const float* pixel = image.Row(v) + column;
  const float z_m = DepthBetween(pixel[0], pixel[1], share);
  if (!(z_m >= limits.min_depth_m)) return kUnusable;
  const float range_m = z_m * (line.h0 + line.h1 * row);
  const float height_m = z_m * (line.g0 + line.g1 * row);
  const bool marks =
      range_m <= limits.max_range_m && height_m >= limits.low_m && height_m <= limits.high_m;
  return marks ? range_m : kPassing;
}

float FindNearest(std::span<const float> samples, const ReturnLimits& limits,
                  const NoiseWindow& window, std::vector<float>& sorted, BearingReturns& returns) {
  sorted.clear();
  const auto needed = static_cast<std::size_t>(limits.min_returns);
  std::size_t last = needed - 1;
  for (std::uint32_t from = 0;;) {
    const std::uint32_t next = SmallestFrom(samples, from);
    if (next >= std::bit_cast<std::uint32_t>(kPassing)) return kPassing;
    const auto sample = std::bit_cast<float>(next);
    sorted.insert(sorted.end(), CountOf(samples, sample), sample);
    from = next + 1;
    for (; last < sorted.size(); ++last) {
      const float smallest = sorted[last + 1 - needed];
      const float width_m = window.At(smallest);
      if (sorted[last] > smallest + width_m) continue;
      const float half_m = 0.5F * width_m;
      const float centre_m = MeanWithin(samples, smallest, smallest + width_m, smallest);
      returns.hit = true;
      returns.range_m = MeanWithin(samples, centre_m - half_m, centre_m + half_m, centre_m);
      return std::max(smallest + width_m, centre_m + half_m);
    }
  }
}

}  // namespace depthgrid
