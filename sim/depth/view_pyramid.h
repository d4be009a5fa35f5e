// The view frustum of a camera: the pyramid of its image, cut off at the ends of the sensor's depth
// range.
#pragma once

#include <array>
#include <optional>

#include "mapper/core/camera.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// An interval, low <= high.
struct ValueSpan {
  double low = 0.0;
  double high = 0.0;
};

class ViewPyramid {
 public:
  ViewPyramid(const PinholeCamera& camera, const Pose3& world_from_camera,
              const ValueSpan& depth_m);

  // The part of the line origin + t * direction, t within `span`, that lies in the pyramid (one
  // interval, as it is convex); nothing when there is none.
  std::optional<ValueSpan> Part(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                ValueSpan span) const;
  // Bearings in the world that the image reaches, around `heading_rad`; all of them when the camera
  // sees straight up or down.
  ValueSpan Bearings(double heading_rad) const;

 private:
  Eigen::Vector3d centre_;
  Eigen::Vector3d axis_;                    // of length 1
  ValueSpan depth_m_;                       // along it
  std::array<Eigen::Vector3d, 4> inward_;   // normals of the four sides
  std::array<Eigen::Vector3d, 4> corners_;  // directions
};

}  // namespace depthgrid
