// Depth images as a camera without distortion would have taken them (plumb bob, Brown 1966), so
// that straight lines are straight for all that follows.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"

namespace depthgrid {

// Where a ray of normalised coordinates (x/z, y/z) falls in the image of the distorted camera.
Eigen::Vector2d DistortedPixel(const PinholeCamera& camera, const Eigen::Vector2d& normalised);

class Undistorter {
 public:
  explicit Undistorter(const PinholeCamera& camera);

  // Same size and intrinsics, no distortion.
  PinholeCamera camera() const;
  // Depth is the z of the point and does not change with distortion; it is interpolated between the
  // four pixels around where they are one surface, elsewhere the nearest one counts. Pixels whose
  // ray fell outside the image are invalid.
  DepthImage Apply(const DepthImage& distorted) const;

 private:
  PinholeCamera camera_;
  std::vector<Eigen::Vector2f> source_px_;  // of each pixel
};

}  // namespace depthgrid
