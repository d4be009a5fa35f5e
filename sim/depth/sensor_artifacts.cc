#include "sim/depth/sensor_artifacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mapper/core/rng.h"
#include "sim/depth/depth_noise_models.h"

namespace depthgrid {
namespace {

// Of the 4-neighbours across a depth edge from pixel (u, v), the depth that differs most from the
// pixel's; its own depth when there is none.
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
    if (!noise::IsBreak({.z = z,
                         .z_other = neighbour_z,
                         .apart_px = 1.0F,
                         .cosine = clean.incidence_cos[index],
                         .focal_px = focal_px})) {
      return;
    }
    if (std::abs(neighbour_z - z) > std::abs(other - z)) other = neighbour_z;
  };
  look(u - 1, v);
  look(u + 1, v);
  look(u, v - 1);
  look(u, v + 1);
  return other;
}

float UniformOf(std::uint32_t word) { return (static_cast<float>(word >> 9) + 0.5F) * 0x1.0p-23F; }

// An image row as seen by the projector: each pixel is shifted by its disparity f b / z.
class ProjectorRow {
 public:
  // `fb` is focal length times baseline, pixels times metres; negative for a projector to the left.
  ProjectorRow(int width_px, float fb)
      : width_(width_px),
        fb_(fb),
        columns_(static_cast<std::size_t>(width_px)),
        nearest_(static_cast<std::size_t>(3 * width_px)) {}

  // Invalidates the pixels that nearer surfaces of the row shadow.
  void Shade(float* z_m) {
    std::fill(nearest_.begin(), nearest_.end(), 0.0F);
    for (int u = 0; u < width_; ++u) {
      const float disparity = DisparityOf(z_m[u]);
      const float shift = fb_ < 0 ? -disparity : disparity;
      Column(u) = width_ + static_cast<int>(std::floor(static_cast<float>(u) - shift + 0.5F));
    }
    for (int u = 0; u < width_; ++u) LightFrom(z_m, u);
    for (int u = 0; u < width_; ++u) {
      if (!IsSeen(Column(u))) continue;
      if (Nearest(Column(u)) > DisparityOf(z_m[u]) + kBiasPx) z_m[u] = kInvalidDepth;
    }
  }

 private:
  static constexpr float kBiasPx = 1.5F;       // keeps slanted surfaces from shadowing themselves
  static constexpr int kWidestGapColumns = 4;  // neighbours further apart are different surfaces

  float DisparityOf(float z_m) const { return z_m > 0.0F ? std::abs(fb_) / z_m : 0.0F; }
  int& Column(int u) { return columns_[static_cast<std::size_t>(u)]; }
  // False for disparities beyond the image's width, i.e. depths below f b / width.
  bool IsSeen(int column) const {
    return column >= 0 && column < static_cast<int>(nearest_.size());
  }
  float& Nearest(int column) { return nearest_[static_cast<std::size_t>(column)]; }
  void Light(int column, float disparity) {
    if (IsSeen(column)) Nearest(column) = std::max(Nearest(column), disparity);
  }
  // Enters the surface between pixel u and its right neighbour.
  void LightFrom(const float* z_m, int u) {
    if (z_m[u] <= 0.0F) return;
    const float disparity = DisparityOf(z_m[u]);
    Light(Column(u), disparity);
    if (u + 1 == width_ || z_m[u + 1] <= 0.0F) return;
    const int next = Column(u + 1);
    if (next - Column(u) > kWidestGapColumns) return;
    for (int between = Column(u) + 1; between < next; ++between) {
      Light(between, std::min(disparity, DisparityOf(z_m[u + 1])));
    }
  }

  int width_;
  float fb_;
  std::vector<int> columns_;    // projector column of each pixel
  std::vector<float> nearest_;  // largest disparity in each projector column; offset by width_
};

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
  ProjectorRow projector(depth.width_px, static_cast<float>(camera.fx_px * baseline_m));
  for (int v = 0; v < depth.height_px; ++v) projector.Shade(depth.Row(v));
}

void DropEdges(const DepthImage& clean, float step_m, DepthImage& measured) {
  const int width = clean.width_px, height = clean.height_px;
  // Minimum and maximum over three rows, then over three columns.
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
