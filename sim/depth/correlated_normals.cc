#include "sim/depth/correlated_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapper/core/error.h"
#include "sim/depth/parallel_calls.h"

namespace depthgrid {
namespace {

// Half of a Gaussian kernel, from the centre outwards, that gives white noise this correlation
// length.
std::vector<float> Weights(double length_px) {
  const double sigma_px = length_px / std::numbers::sqrt2;
  constexpr double kReachSigmas = 3.5;  // beyond, weights are below 0.002 of the centre's
  std::vector<float> weights;
  for (int d = 0; d <= static_cast<int>(kReachSigmas * sigma_px); ++d) {
    const double sigmas = d / sigma_px;  // first: the square of a tiny sigma underflows
    weights.push_back(static_cast<float>(std::exp(-0.5 * sigmas * sigmas)));
  }
  return weights;
}

// The factor that gives variance 1 at index `at` of `count`, where weights outside are left out.
float ScaleAt(const std::vector<float>& weights, std::size_t at, std::size_t count) {
  double squares = 0.0;
  for (std::size_t d = 0; d < weights.size(); ++d) {
    const double square = static_cast<double>(weights[d]) * weights[d];
    if (at >= d) squares += square;
    if (d > 0 && at + d < count) squares += square;
  }
  return static_cast<float>(1.0 / std::sqrt(squares));
}

void SmoothRow(const float* row, std::size_t width, const std::vector<float>& weights,
               const std::vector<float>& scales, float* smooth) {
  std::fill_n(smooth, width, 0.0F);
  for (std::size_t d = 0; d < std::min(weights.size(), width); ++d) {
    const float weight = weights[d];
    for (std::size_t u = 0; u + d < width; ++u) smooth[u] += weight * row[u + d];
    if (d == 0) continue;
    for (std::size_t u = d; u < width; ++u) smooth[u] += weight * row[u - d];
  }
  for (std::size_t u = 0; u < width; ++u) smooth[u] *= scales[u];
}

}  // namespace

std::vector<float> Correlated(const std::vector<float>& white, std::size_t width_px,
                              double length_px, int threads) {
  Require(width_px > 0 && white.size() % width_px == 0, "whole rows");
  const std::size_t height_px = white.size() / width_px;
  const std::vector<float> weights = Weights(length_px);
  std::vector<float> scales(width_px);
  for (std::size_t u = 0; u < width_px; ++u) scales[u] = ScaleAt(weights, u, width_px);
  std::vector<float> along_rows(white.size()), smooth(white.size(), 0.0F);
  CallInParallel(height_px, threads, [&](std::size_t v) {
    const std::size_t first = v * width_px;
    SmoothRow(white.data() + first, width_px, weights, scales, along_rows.data() + first);
  });
  CallInParallel(height_px, threads, [&](std::size_t v) {
    float* const out = smooth.data() + v * width_px;
    const auto add = [&](float weight, std::size_t from) {
      const float* const row = along_rows.data() + from * width_px;
      for (std::size_t u = 0; u < width_px; ++u) out[u] += weight * row[u];
    };
    for (std::size_t d = 0; d < weights.size(); ++d) {
      if (v >= d) add(weights[d], v - d);
      if (d > 0 && v + d < height_px) add(weights[d], v + d);
    }
    const float scale = ScaleAt(weights, v, height_px);
    for (std::size_t u = 0; u < width_px; ++u) out[u] *= scale;
  });
  return smooth;
}

}  // namespace depthgrid
