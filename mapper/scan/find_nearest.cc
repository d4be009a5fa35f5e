#include <algorithm>
#include <functional>
#include <iterator>
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
                  const NoiseWindow& window, std::vector<float>& heap, BearingReturns& returns) {
  // Samples come out of the heap in increasing order, to its end, and few of them do before one is
  // supported.
  heap.clear();
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(heap),
               [](float sample) { return sample < kPassing; });
  std::make_heap(heap.begin(), heap.end(), std::greater<>());
  const auto needed = static_cast<std::ptrdiff_t>(limits.min_returns);
  for (auto end = heap.end(); end != heap.begin();) {
    std::pop_heap(heap.begin(), end, std::greater<>());
    const auto largest = --end;
    if (heap.end() - largest < needed) continue;
    const float smallest = *(largest + needed - 1);
    const float width_m = window.At(smallest);
    if (*largest > smallest + width_m) continue;
    const float half_m = 0.5F * width_m;
    const float centre_m = MeanWithin(samples, smallest, smallest + width_m, smallest);
    returns.hit = true;
    returns.range_m = MeanWithin(samples, centre_m - half_m, centre_m + half_m, centre_m);
    return std::max(smallest + width_m, centre_m + half_m);
  }
  return kPassing;
}

}  // namespace depthgrid
