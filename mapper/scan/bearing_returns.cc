#include "mapper/scan/bearing_returns.h"

#include <algorithm>

namespace depthgrid {
namespace {

float SampleAt(const DepthImage& image, const BearingLine& line, const ReturnLimits& limits,
               int v) {
  const auto row = static_cast<float>(v);
  const float u = line.u0 + line.u1 * row;
  const float base = std::clamp(std::floor(u), 0.0F, static_cast<float>(image.width_px - 2));
  const float share = std::clamp(u - base, 0.0F, 1.0F);
  const float* pixel = image.Row(v) + static_cast<int>(base);
  const float z_m = DepthBetween(pixel[0], pixel[1], share);
  if (!(z_m >= limits.min_depth_m)) return kUnusable;
  const float range_m = z_m * (line.h0 + line.h1 * row);
  const float height_m = z_m * (line.g0 + line.g1 * row);
  const bool marks =
      range_m <= limits.max_range_m && height_m >= limits.low_m && height_m <= limits.high_m;
  return marks ? range_m : kPassing;
}

float MeanWithin(const std::vector<float>& samples, float low, float high, float otherwise) {
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

// The nearest range that enough samples agree on: the mean over the noise window above the smallest
// supported sample, once more centred on itself.
void FindNearest(const std::vector<float>& samples, const ReturnLimits& limits,
                 const NoiseWindow& window, BearingReturns& returns) {
  std::vector<float> sorted = samples;
  std::sort(sorted.begin(), sorted.end());
  const auto needed = static_cast<std::size_t>(limits.min_returns - 1);
  for (std::size_t i = 0; i + needed < sorted.size() && sorted[i] < kPassing; ++i) {
    const float width_m = window.At(sorted[i]);
    if (sorted[i + needed] > sorted[i] + width_m) continue;
    const float half_m = 0.5F * width_m;
    const float centre_m = MeanWithin(samples, sorted[i], sorted[i] + width_m, sorted[i]);
    returns.hit = true;
    returns.range_m = MeanWithin(samples, centre_m - half_m, centre_m + half_m, centre_m);
    return;
  }
}

// The longest run of unusable rows between usable ones, below and above the horizon.
void FindGaps(const std::vector<float>& samples, const BearingLine& line, int first_row,
              BearingReturns& returns) {
  const auto consider = [](RowRange& longest, int from, int to) {
    if (to - from > 1 && to - from > longest.last - longest.first) longest = {from, to};
  };
  int last_seen = -1;
  for (int v = first_row; v < first_row + static_cast<int>(samples.size()); ++v) {
    if (samples[static_cast<std::size_t>(v - first_row)] == kUnusable) continue;
    if (last_seen < 0) {
      returns.seen.first = v;
    } else {
      // Height of the ray at the gap's end decides: a gap across the horizon counts as either.
      const bool above = line.g0 + line.g1 * static_cast<float>(v) > 0.0F;
      consider(above ? returns.gap_above : returns.gap_below, last_seen, v);
    }
    last_seen = v;
    returns.seen.last = v;
  }
}

}  // namespace

std::vector<float> SamplesOf(const DepthImage& image, const BearingLine& line,
                             const ReturnLimits& limits, RowRange& rows) {
  rows = {std::max(line.first_row, limits.first_row), std::min(line.last_row, limits.last_row)};
  std::vector<float> samples;
  for (int v = rows.first; v <= rows.last; ++v) {
    samples.push_back(SampleAt(image, line, limits, v));
  }
  return samples;
}

std::vector<BearingReturns> FindReturns(const DepthImage& image,
                                        const std::vector<BearingLine>& lines,
                                        const ReturnLimits& limits, const NoiseWindow& window) {
  std::vector<BearingReturns> all;
  all.reserve(lines.size());
  for (const BearingLine& line : lines) {
    RowRange rows;
    const std::vector<float> samples = SamplesOf(image, line, limits, rows);
    BearingReturns returns;
    FindNearest(samples, limits, window, returns);
    FindGaps(samples, line, rows.first, returns);
    all.push_back(returns);
  }
  return all;
}

}  // namespace depthgrid
