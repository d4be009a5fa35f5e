#include "sim/depth/depth_samples.h"

#include <algorithm>
#include <cmath>

#include "sim/depth/depth_noise_models.h"

namespace depthgrid::noise {
namespace {

constexpr std::size_t kItems = kNormalBlockItems;
using Indices = std::array<std::int32_t, kItems>;

struct Pixels {
  float u[kItems];
  float v[kItems];
};

// Pixel coordinates of a block. Beyond the last pixel they continue in rows below the image and are
// clamped later.
Pixels PixelsOf(std::size_t first, int width_px) {
  Pixels pixels;
  const auto width = static_cast<std::size_t>(width_px);
  std::size_t u = first % width, v = first / width;
  for (std::size_t i = 0; i < kItems;) {
    const std::size_t run = std::min(width - u, kItems - i);
    for (std::size_t k = 0; k < run; ++k) {
      pixels.u[i + k] = static_cast<float>(static_cast<std::int32_t>(u + k));
    }
    std::fill_n(pixels.v + i, run, static_cast<float>(v));
    i += run;
    u = 0;
    ++v;
  }
  return pixels;
}

float Clamp(float x, float high) { return std::min(std::max(x, 0.0F), high); }

}  // namespace

DepthSamples SampleInPlace(const SampleSource& source, std::size_t first, std::size_t count) {
  DepthSamples samples;
  std::copy_n(source.depth.z_m.data() + first, count, samples.z.data());
  std::copy_n(source.incidence_cos + first, count, samples.cosine.data());
  std::fill(samples.z.data() + count, samples.z.data() + kItems, 0.0F);
  std::fill(samples.cosine.data() + count, samples.cosine.data() + kItems, 0.0F);
  return samples;
}

DepthSamples SampleAcrossEdges(const SampleSource& source, std::size_t first, std::size_t count,
                               const NormalBlock& random, float scale) {
  DepthSamples samples = SampleInPlace(source, first, count);
  // A ray without a hit has a cosine of 0 but no incidence; the silhouette beside it gets the
  // lateral noise of normal incidence.
  for (float& cosine : samples.cosine) cosine = Select(cosine > 0.0F, cosine, 1.0F);
  const Pixels pixels = PixelsOf(first, source.depth.width_px);
  const auto width = static_cast<std::int32_t>(source.depth.width_px);
  const auto last_u = static_cast<float>(source.depth.width_px - 1);
  const auto last_v = static_cast<float>(source.depth.height_px - 1);
  const float* const normal_u = random.normals[kLateralU].data();
  const float* const normal_v = random.normals[kLateralV].data();
  alignas(64) Indices other;
  alignas(64) Values shift_px;
  for (std::size_t i = 0; i < kItems; ++i) {
    const float sigma_px = scale * NguyenLateralSigmaPx(Acos(samples.cosine[i]));
    const float u = Whole(Clamp(pixels.u[i] + sigma_px * normal_u[i], last_u) + 0.5F);
    const float v = Whole(Clamp(pixels.v[i] + sigma_px * normal_v[i], last_v) + 0.5F);
    const float du = u - pixels.u[i], dv = v - pixels.v[i];
    shift_px[i] = std::sqrt(du * du + dv * dv);
    other[i] = static_cast<std::int32_t>(v) * width + static_cast<std::int32_t>(u);
  }
  const float* const z = source.depth.z_m.data();
  alignas(64) Values other_z, other_cosine;
  for (std::size_t i = 0; i < kItems; ++i) {
    other_z[i] = z[other[i]];
    other_cosine[i] = source.incidence_cos[other[i]];
  }
  for (std::size_t i = 0; i < kItems; ++i) {
    // An invalid depth (0) differs from any other surface.
    const bool moves = IsBreak({.z = samples.z[i],
                                .z_other = other_z[i],
                                .apart_px = shift_px[i],
                                .cosine = samples.cosine[i],
                                .focal_px = source.focal_px});
    samples.z[i] = Select(moves, other_z[i], samples.z[i]);
    samples.cosine[i] = Select(moves, other_cosine[i], samples.cosine[i]);
  }
  return samples;
}

DepthSamples SampleBetweenPixels(const SampleSource& source, std::size_t first, std::size_t count,
                                 const NormalBlock& random, float sigma_px) {
  const Pixels pixels = PixelsOf(first, source.depth.width_px);
  const auto width = static_cast<std::int32_t>(source.depth.width_px);
  const auto last_u = static_cast<float>(source.depth.width_px - 1);
  const auto last_v = static_cast<float>(source.depth.height_px - 1);
  const float* const normal_u = random.normals[kLateralU].data();
  const float* const normal_v = random.normals[kLateralV].data();
  // The four surrounding pixels, which coincide at the image's last column and row.
  alignas(64) Indices corner, right_of, below, nearest;
  alignas(64) Values right, down;
  for (std::size_t i = 0; i < kItems; ++i) {
    const float x = Clamp(pixels.u[i] + sigma_px * normal_u[i], last_u);
    const float y = Clamp(pixels.v[i] + sigma_px * normal_v[i], last_v);
    const float u = Whole(x), v = Whole(y);
    const float next_u = std::min(u + 1.0F, last_u), next_v = std::min(v + 1.0F, last_v);
    right[i] = x - u;
    down[i] = y - v;
    const float near_u = Select(right[i] >= 0.5F, next_u, u);
    const float near_v = Select(down[i] >= 0.5F, next_v, v);
    const std::int32_t row = static_cast<std::int32_t>(v) * width;
    const std::int32_t next_row = static_cast<std::int32_t>(next_v) * width;
    corner[i] = row + static_cast<std::int32_t>(u);
    right_of[i] = static_cast<std::int32_t>(next_u) - static_cast<std::int32_t>(u);
    below[i] = next_row - row;
    nearest[i] = static_cast<std::int32_t>(near_v) * width + static_cast<std::int32_t>(near_u);
  }
  const float* const inverse_z = source.inverse_z.data();
  DepthSamples samples;
  alignas(64) Values a, b, c, d, near;
  for (std::size_t i = 0; i < kItems; ++i) {
    a[i] = inverse_z[corner[i]];
    b[i] = inverse_z[corner[i] + right_of[i]];
    c[i] = inverse_z[corner[i] + below[i]];
    d[i] = inverse_z[corner[i] + below[i] + right_of[i]];
    near[i] = inverse_z[nearest[i]];
    samples.cosine[i] = source.incidence_cos[nearest[i]];
  }
  for (std::size_t i = 0; i < kItems; ++i) {
    const float p = a[i], q = b[i], r = c[i], s = d[i];
    const float low = std::min(std::min(p, q), std::min(r, s));
    const float high = std::max(std::max(p, q), std::max(r, s));
    constexpr float kDiagonalPx = 1.41421356F;
    // An invalid depth (0) differs from any other surface. These are inverse depths; their ratio is
    // that of the depths.
    const bool breaks = IsBreak({.z = high,
                                 .z_other = low,
                                 .apart_px = kDiagonalPx,
                                 .cosine = samples.cosine[i],
                                 .focal_px = source.focal_px});
    const float top = p + right[i] * (q - p), bottom = r + right[i] * (s - r);
    const float between = top + down[i] * (bottom - top);
    const float inverse = Select(breaks, near[i], between);
    samples.z[i] = Select(inverse > 0.0F, 1.0F / inverse, 0.0F);
  }
  std::fill(samples.z.data() + count, samples.z.data() + kItems, 0.0F);
  return samples;
}

}  // namespace depthgrid::noise
