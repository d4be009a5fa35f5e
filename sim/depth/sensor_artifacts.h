// What a depth sensor does to an image before its noise: pixels that mix two surfaces, and the
// shadow of a pattern projector that stands beside the camera.
#pragma once

#include <cstdint>

#include "mapper/core/camera.h"
#include "sim/depth/depth_camera.h"

namespace depthgrid {

// Pixels next to a depth edge measure, with the given probability, a depth drawn uniformly between
// their own surface's and that of the neighbour furthest from it.
DepthImage WithFlyingPixels(const DepthFrame& clean, const PinholeCamera& camera,
                            double probability, std::uint64_t seed, std::uint32_t frame);

// Invalidates what a projector `baseline_m` to the camera's right does not light, as far as the
// image itself shows what stands in its way: a surface whose projector column (u - f b / z) is
// covered by one of more than 1.5 pixels more disparity.
void CastProjectorShadow(DepthImage& depth, const PinholeCamera& camera, double baseline_m);

// Invalidates the pixels of `measured` whose 3x3 neighbours in `clean` lie further apart than
// step_m; invalid neighbours count for nothing.
void DropEdges(const DepthImage& clean, float step_m, DepthImage& measured);

}  // namespace depthgrid
