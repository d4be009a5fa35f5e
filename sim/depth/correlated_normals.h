// Standard normals that are alike in neighbouring pixels, as the errors of sensors are that compare
// blocks of pixels or smooth.
#pragma once

#include <cstddef>
#include <vector>

namespace depthgrid {

// White normals of an image, row by row, become such whose correlation at a distance of d pixels is
// exp(-(d / length_px)^2 / 2), up to the image's edges. Their variance stays 1. Lengths below half
// a pixel or so change next to nothing.
std::vector<float> Correlated(const std::vector<float>& white, std::size_t width_px,
                              double length_px, int threads);

}  // namespace depthgrid
