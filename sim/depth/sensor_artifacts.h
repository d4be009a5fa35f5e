// Sensor artifacts that are applied before the noise: pixels that mix two surfaces, and the shadow
// of a pattern projector beside the camera.
#pragma once

#include <cstdint>

#include "mapper/core/camera.h"
#include "sim/depth/depth_camera.h"

namespace depthgrid {

// Pixels next to a depth edge measure, with the given probability, a depth drawn uniformly between
// their own surface's and that of the neighbour furthest from it.
DepthImage WithFlyingPixels(const DepthFrame& clean, const PinholeCamera& camera,
                            double probability, std::uint64_t seed, std::uint32_t frame);

// Invalidates the pixels that a projector `baseline_m` to the camera's right does not light, judged
// by the surfaces in the image: those whose projector column u - f b / z is covered by a surface of
// more than 1.5 pixels more disparity.
void CastProjectorShadow(DepthImage& depth, const PinholeCamera& camera, double baseline_m);

// Invalidates the pixels of `measured` whose 3x3 neighbours in `clean` lie further apart than
// step_m; invalid neighbours are ignored.
void DropEdges(const DepthImage& clean, float step_m, DepthImage& measured);

}  // namespace depthgrid
