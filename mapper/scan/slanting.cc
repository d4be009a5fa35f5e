#include "mapper/scan/slanting.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/scan.h"

namespace depthgrid {
namespace {

struct Sample {
  float range_m = 0.0F;
  float slope = 0.0F;  // height over range
};

bool AreOneSurface(const Sample& a, const Sample& b, const NoiseWindow& window) {
  const float nearer_m = std::min(a.range_m, b.range_m);
  const float steep_m =
      static_cast<float>(kSteepestTangent) * std::abs(a.slope - b.slope) * nearer_m;
  return std::abs(a.range_m - b.range_m) <= window.At(nearer_m) + steep_m;
}

}  // namespace

float NearestSlanting(std::span<const float> samples, int first_row, const BearingLine& line,
                      const ReturnLimits& limits, const NoiseWindow& window, float nearer_than_m) {
  float nearest_m = kPassing, nearest_of_run_m = kPassing;
  int run = 0;
  Sample last;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i] == kUnusable) continue;
    if (samples[i] >= nearer_than_m || samples[i] > limits.max_range_m) {
      run = 0;
      continue;
    }
    const auto row = static_cast<float>(first_row + static_cast<int>(i));
    const Sample sample{samples[i], (line.g0 + line.g1 * row) / (line.h0 + line.h1 * row)};
    const bool goes_on = run > 0 && AreOneSurface(last, sample, window);
    run = goes_on ? run + 1 : 1;
    nearest_of_run_m = goes_on ? std::min(nearest_of_run_m, sample.range_m) : sample.range_m;
    if (run >= limits.min_returns) nearest_m = std::min(nearest_m, nearest_of_run_m);
    last = sample;
  }
  return nearest_m;
}

float FindNearestOrSlanting(std::span<const float> samples, int first_row, const BearingLine& line,
                            const ReturnLimits& limits, const NoiseWindow& window,
                            std::vector<float>& sorted, BearingReturns& returns) {
  const float supported_m = SmallestSupported(samples, limits, window, sorted);
  const auto nearer = std::lower_bound(sorted.begin(), sorted.end(), supported_m) - sorted.begin();
  float nearest_m = supported_m;
  if (nearer >= limits.min_returns) {
    const float slanting_m = NearestSlanting(samples, first_row, line, limits, window, supported_m);
    nearest_m = std::min(nearest_m, slanting_m);
  }
  if (nearest_m >= kPassing) return kPassing;
  return std::max(supported_m, RangeFrom(samples, nearest_m, window, returns));
}

}  // namespace depthgrid
