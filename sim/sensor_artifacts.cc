#include "sim/sensor_artifacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mapper/core/rng.h"
#include "sim/depth_noise_models.h"

namespace depthgrid {
namespace {

// The depth of the 4-neighbour furthest from pixel (u, v)'s among those across a depth edge, or its
// own when none is.
float AcrossEdge(const DepthFrame& clean, const PinholeCamera& camera, int u, int v) {
  const DepthImage& depth = clean.depth;
  const float z = depth.At(u, v);
  const auto index = static_cast<std::size_t>(v) * static_cast<std::size_t>(depth.width_px) +
                     static_cast<std::size_t>(u);
  const auto focal_px = static_cast<float>(std::min(camera.fx_px, camera.fy_px));
  float other = z;
  const auto look = [&](int neighbour_u, int neighbour_v) {
    if (neighbour_u < 0 || neighbour_v < 0 || neighbour_u >= depth.width_px ||
        neighbour_v >= depth.height_px) {
      return;
    }
    const float neighbour_z = depth.At(neighbour_u, neighbour_v);
    if (neighbour_z <= 0.0F) return;
    if (!noise::IsBreak(z, neighbour_z, 1.0F, clean.incidence_cos[index], focal_px)) return;
    if (std::abs(neighbour_z - z) > std::abs(other - z)) other = neighbour_z;
  };
  look(u - 1, v);
  look(u + 1, v);
  look(u, v - 1);
  look(u, v + 1);
  return other;
}

float UniformOf(std::uint32_t word) { return (static_cast<float>(word >> 9) + 0.5F) * 0x1.0p-23F; }

}  // namespace

DepthImage WithFlyingPixels(const DepthFrame& clean, const PinholeCamera& camera,
                            double probability, std::uint64_t seed, std::uint32_t frame) {
  DepthImage mixed = clean.depth;
  for (int v = 0; v < mixed.height_px; ++v) {
    for (int u = 0; u < mixed.width_px; ++u) {
      const float z = clean.depth.At(u, v);
      if (z <= 0.0F) continue;
      const float other = AcrossEdge(clean, camera, u, v);
      if (other == z) continue;
      const auto pixel = static_cast<std::uint32_t>(v * mixed.width_px + u);
      const auto words = RandomWords(seed, RandomStage::kFlyingPixels, frame, pixel);
      if (UniformOf(words[0]) < probability)
        mixed.Row(v)[u] = z + UniformOf(words[1]) * (other - z);
    }
  }
  return mixed;
}

void CastProjectorShadow(DepthImage& depth, const PinholeCamera& camera, double baseline_m) {
  constexpr float kBiasPx = 1.5F;       // a slanted surface does not shade itself
  constexpr int kWidestGapColumns = 4;  // neighbours further apart are different surfaces
  const int width = depth.width_px;
  // Disparities beyond the image's width leave the projector's buffer: nearer than f b / width.
  const auto span = static_cast<std::size_t>(3 * width);
  const auto fb = static_cast<float>(camera.fx_px * baseline_m);
  std::vector<float> nearest(span);
  std::vector<int> columns(static_cast<std::size_t>(width));
  for (int v = 0; v < depth.height_px; ++v) {
    float* const row = depth.Row(v);
    std::fill(nearest.begin(), nearest.end(), 0.0F);
    const auto disparity = [&](int u) { return row[u] > 0.0F ? std::abs(fb) / row[u] : 0.0F; };
    const auto light = [&](int column, float with_disparity) {
      if (column < 0 || column >= static_cast<int>(span)) return;
      float& kept = nearest[static_cast<std::size_t>(column)];
      kept = std::max(kept, with_disparity);
    };
    for (int u = 0; u < width; ++u) {
      const float shift = fb < 0 ? -disparity(u) : disparity(u);
      columns[static_cast<std::size_t>(u)] =
          width + static_cast<int>(std::floor(static_cast<float>(u) - shift + 0.5F));
    }
    for (int u = 0; u < width; ++u) {
      if (row[u] <= 0.0F) continue;
      const int column = columns[static_cast<std::size_t>(u)];
      light(column, disparity(u));
      if (u + 1 == width || row[u + 1] <= 0.0F) continue;
      const int next = columns[static_cast<std::size_t>(u + 1)];
      if (next - column > kWidestGapColumns) continue;
      for (int between = column + 1; between < next; ++between) {
        light(between, std::min(disparity(u), disparity(u + 1)));
      }
    }
    for (int u = 0; u < width; ++u) {
      const int column = columns[static_cast<std::size_t>(u)];
      if (column < 0 || column >= static_cast<int>(span)) continue;
      if (nearest[static_cast<std::size_t>(column)] > disparity(u) + kBiasPx) {
        row[u] = kInvalidDepth;
      }
    }
  }
}

void DropEdges(const DepthImage& clean, float step_m, DepthImage& measured) {
  const int width = clean.width_px, height = clean.height_px;
  // Columns first, then along the row: of three rows, then of three columns.
  std::vector<float> low(static_cast<std::size_t>(width) + 2), high(low.size());
  for (int v = 0; v < height; ++v) {
    const float* const above = clean.Row(std::max(v - 1, 0));
    const float* const here = clean.Row(v);
    const float* const below = clean.Row(std::min(v + 1, height - 1));
    const auto or_far = [](float z) {
      return z > 0.0F ? z : std::numeric_limits<float>::infinity();
    };
    for (std::size_t u = 0; u < static_cast<std::size_t>(width); ++u) {
      low[u + 1] = std::min(std::min(or_far(above[u]), or_far(below[u])), or_far(here[u]));
      high[u + 1] = std::max(std::max(above[u], below[u]), here[u]);
    }
    low.front() = low[1], high.front() = high[1];
    low.back() = low[low.size() - 2], high.back() = high[high.size() - 2];
    float* const row = measured.Row(v);
    for (std::size_t u = 0; u < static_cast<std::size_t>(width); ++u) {
      const float step = std::max(std::max(high[u], high[u + 1]), high[u + 2]) -
                         std::min(std::min(low[u], low[u + 1]), low[u + 2]);
      row[u] = step > step_m ? kInvalidDepth : row[u];
    }
  }
}

}  // namespace depthgrid
