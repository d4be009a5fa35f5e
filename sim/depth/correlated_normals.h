// Spatially correlated standard normals: the errors of sensors that match blocks of pixels or
// smooth are correlated between neighbouring pixels.
#pragma once

#include <cstddef>
#include <vector>

namespace depthgrid {

// Filters the white normals of an image (row-major) so that their correlation at a distance of d
// pixels is exp(-(d / length_px)^2 / 2). The variance is 1 everywhere, also at the image's edges.
// Lengths below about half a pixel have next to no effect.
std::vector<float> Correlated(const std::vector<float>& white, std::size_t width_px,
                              double length_px, int threads);

}  // namespace depthgrid
