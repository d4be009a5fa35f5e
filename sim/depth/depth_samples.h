// Where in the clean image a noisy pixel takes its depth from: in place, or shifted by a draw.
// Works on blocks of pixels so that the arithmetic vectorises; only for sim's own noise.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/core/normal_block.h"

namespace depthgrid::noise {

using Values = std::array<float, kNormalBlockItems>;

// A clean frame, prepared for looking around in it.
struct SampleSource {
  const DepthImage& depth;
  const float* incidence_cos;
  std::vector<float> inverse_z;  // 1/z, 0 where invalid
  float focal_px;
};

// The clean depth behind kNormalBlockItems pixels in row-major order; z = 0 is invalid.
struct DepthSamples {
  alignas(64) Values z;
  alignas(64) Values cosine;  // of the incidence where z was taken
};

// `count` pixels from pixel `first` on; the rest of the block is invalid.
DepthSamples SampleInPlace(const SampleSource& source, std::size_t first, std::size_t count);

// Silhouettes move: the pixel takes the depth of the one at a shift of (normals 0, 1) times
// Nguyen's lateral sigma and `scale`, if that one is on another surface. Within a surface it keeps
// its own depth: the axial sigma was measured on planes and already holds what a shift does there.
DepthSamples SampleAcrossEdges(const SampleSource& source, std::size_t first, std::size_t count,
                               const NormalBlock& random, float scale);

// The depth at a shift of (normals 0, 1) times sigma_px. Between pixels of one surface 1/z is
// interpolated, which is exact on planes; where the four pixels around are not one surface, the
// nearest is taken.
DepthSamples SampleBetweenPixels(const SampleSource& source, std::size_t first, std::size_t count,
                                 const NormalBlock& random, float sigma_px);

}  // namespace depthgrid::noise
