// Removes lens distortion (plumb bob, Brown 1966) from depth images, so that all later steps can
// assume a pinhole camera.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"

namespace depthgrid {

// The pixel of the distorted image for a ray with normalised coordinates (x/z, y/z).
Eigen::Vector2d DistortedPixel(const PinholeCamera& camera, const Eigen::Vector2d& normalised);

class Undistorter {
 public:
  explicit Undistorter(const PinholeCamera& camera);

  // Same size and intrinsics, no distortion.
  PinholeCamera camera() const;
  // Depth is z, which distortion does not change. It is interpolated between the four surrounding
  // pixels if they are one surface, else the nearest is taken. Pixels whose ray is outside the
  // image are invalid.
  DepthImage Apply(const DepthImage& distorted) const;

 private:
  PinholeCamera camera_;
  std::vector<Eigen::Vector2f> source_px_;  // per pixel of the result
};

}  // namespace depthgrid
