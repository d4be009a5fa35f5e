// The clean depth that a noisy pixel measures: its own, or that at a random shift in the image.
// Works on blocks of pixels so that the arithmetic vectorises. Internal to sim's noise.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/core/normal_block.h"

namespace depthgrid::noise {

using Values = std::array<float, kNormalBlockItems>;

// What each of a pixel's four normals (NormalBlock::normals) is for.
constexpr std::size_t kLateralU = 0;
constexpr std::size_t kLateralV = 1;
constexpr std::size_t kAxial = 2;
constexpr std::size_t kGrazing = 3;  // of the softness of the grazing limit

// A clean frame with the inverse depths that sampling needs.
struct SampleSource {
  const DepthImage& depth;
  const float* incidence_cos;
  std::vector<float> inverse_z;  // 1/z, 0 where invalid
  float focal_px;
};

// The clean depth behind kNormalBlockItems pixels in row-major order; z = 0 is invalid.
struct DepthSamples {
  alignas(64) Values z;
  alignas(64) Values cosine;  // of the incidence at the point z was taken from
};

// The depths of `count` pixels from pixel `first` on; the rest of the block is invalid.
DepthSamples SampleInPlace(const SampleSource& source, std::size_t first, std::size_t count);

// Lateral noise at silhouettes: the pixel takes the depth at a shift of its lateral normals
// times Nguyen's lateral sigma times `scale` if that lies on another surface. Within a surface it
// keeps its own depth: the axial sigma was measured on planes and so includes the effect of lateral
// shifts.
DepthSamples SampleAcrossEdges(const SampleSource& source, std::size_t first, std::size_t count,
                               const NormalBlock& random, float scale);

// The depth at a shift of the lateral normals times sigma_px. Between pixels of one surface 1/z is
// interpolated, which is exact on planes; where the four surrounding pixels are not one surface,
// the nearest pixel is taken.
DepthSamples SampleBetweenPixels(const SampleSource& source, std::size_t first, std::size_t count,
                                 const NormalBlock& random, float sigma_px);

}  // namespace depthgrid::noise
