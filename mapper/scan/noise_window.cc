#include "mapper/scan/noise_window.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "mapper/scan/few_columns.h"

namespace depthgrid {
namespace {

// 1,280 samples of an image of 640 or 160 columns, along few rows for memory locality.
constexpr int kRows = 16;
constexpr int kColumnStep = 8;
constexpr int kColumnStepOfFew = 2;
// Columns between the three pixels: sensors smooth over a few pixels, so adjacent ones would show
// too little noise. In images of few columns three pixels so far apart too often see three things,
// which would pass for noise (docs/tried.md, "Images of few columns").
constexpr int kLag = 3;
constexpr int kLagOfFew = 1;

// The quantile of |second difference| that sigma is read from. High, because a quantised sensor
// gives mostly zeros; not higher, because edges of objects fill the top tenth of a furnished room.
constexpr double kQuantile = 0.8;
// That quantile of |N(0, 1)| times sqrt(1 + 4 + 1).
constexpr double kQuantileSigmas = 1.2816 * 2.4495;

constexpr int kMinSamples = 20;
// Classes of the same width for the reach, up to beyond any depth camera; what drivers write for no
// return is farther still.
constexpr int kClassesOfReach = 64;
// Default until measured: Kinect v1 (Nguyen 2012) has 0.0012 to 0.0019 per metre.
constexpr double kDefaultInverseSigma = 0.002;

// The value that std::nth_element puts at `nth`, for non-negative numbers. These have the order of
// their bits, so a bisection over bits works, and its counting vectorises: a fifth of the time for
// 300 values.
float NthSmallest(const std::vector<float>& values, std::size_t nth) {
  std::uint32_t low = 0;
  std::uint32_t high = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
  while (low < high) {
    const std::uint32_t middle = low + (high - low) / 2;
    const auto limit = std::bit_cast<float>(middle);
    std::int32_t up_to = 0;
    for (const float value : values) up_to += value <= limit ? 1 : 0;
    if (static_cast<std::size_t>(up_to) > nth) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return std::bit_cast<float>(low);
}

double InverseSigmaOf(const std::vector<float>& differences) {
  const auto nth = static_cast<std::size_t>(kQuantile * static_cast<double>(differences.size()));
  return static_cast<double>(NthSmallest(differences, nth)) / kQuantileSigmas;
}

}  // namespace

NoiseWindow::NoiseWindow() { inverse_sigma_.fill(kDefaultInverseSigma); }

NoiseWindow::NoiseWindow(const DepthImage& image, Memory& differences) {
  for (std::vector<float>& of_class : differences) of_class.clear();
  std::array<int, kClassesOfReach> measured_at{};
  const bool few = image.width_px <= kFewColumns;
  const int lag = few ? kLagOfFew : kLag;
  const int step = few ? kColumnStepOfFew : kColumnStep;
  const auto row_of = [&](int k) { return image.Row((2 * k + 1) * image.height_px / (2 * kRows)); };
  for (int k = 0; k < kRows; ++k) {
    const float* row = row_of(k);
    const float* next_row = row_of(std::min(k + 1, kRows - 1));
    for (int u = lag; u + lag < image.width_px; u += step) {
      __builtin_prefetch(next_row + u);
      const float left = row[u - lag], here = row[u], right = row[u + lag];
      if (!(left > 0.0F && here > 0.0F && right > 0.0F)) continue;
      // Invalid pixels may have any value, also one too large for an integer.
      const float position = here / static_cast<float>(kClassM);
      if (position >= static_cast<float>(kClassesOfReach)) continue;
      const auto depth_class = static_cast<std::size_t>(position);
      ++measured_at[depth_class];
      if (depth_class >= kClasses) continue;
      const float difference = 1.0F / left - 2.0F / here + 1.0F / right;
      differences[depth_class].push_back(std::abs(difference));
    }
  }
  double last = kDefaultInverseSigma;
  std::array<bool, kClasses> measured{};
  for (std::size_t k = 0; k < kClasses; ++k) {
    measured[k] = measured_at[k] >= kMinSamples;
    if (measured[k]) last = InverseSigmaOf(differences[k]);
    inverse_sigma_[k] = last;
  }
  for (std::size_t k = 0; k < kClassesOfReach; ++k) {
    if (measured_at[k] >= kMinSamples) farthest_m_ = static_cast<double>(k) * kClassM;
  }
  // Classes nearer than the first measured one take its value.
  const auto first = std::find(measured.begin(), measured.end(), true) - measured.begin();
  if (first < kClasses) {
    std::fill_n(inverse_sigma_.begin(), first, inverse_sigma_[static_cast<std::size_t>(first)]);
  }
}

// Like At(range), without branches so that it vectorises.
void NoiseWindow::At(std::span<const float> ranges_m, float* __restrict widths_m) const {
  const auto clamped = [](double value, double low, double high) {
    const double raised = value < low ? low : value;
    return raised > high ? high : raised;
  };
  const float* const ranges = ranges_m.data();
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    const double z_m = ranges[i];
    const double position = clamped(z_m / kClassM - 0.5, 0.0, kClasses - 1.0);
    const int whole = static_cast<int>(position);
    const int below = whole > kClasses - 2 ? kClasses - 2 : whole;
    const double share = position - below;
    const auto at = static_cast<std::size_t>(below);
    const double sigma_m =
        z_m * z_m * ((1.0 - share) * inverse_sigma_[at] + share * inverse_sigma_[at + 1]);
    const double width_m = clamped(kWindowSigmas * sigma_m, kMinWindowM, kMaxWindowM);
    const double least_m = kLeastSigmas * sigma_m;
    widths_m[i] = static_cast<float>(width_m < least_m ? least_m : width_m);
  }
}

}  // namespace depthgrid
