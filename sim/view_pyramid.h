// What a camera's image covers of space: a pyramid of four planes through its centre.
#pragma once

#include <array>
#include <optional>

#include "mapper/core/camera.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// Two numbers of one line, low <= high.
struct Span {
  double low = 0.0;
  double high = 0.0;
};

class ViewPyramid {
 public:
  ViewPyramid(const PinholeCamera& camera, const Pose3& world_from_camera);

  bool Holds(const Eigen::Vector3d& point) const;
  // The part of the line origin + t * direction, t within `span`, that lies in the pyramid, which
  // is convex; nothing when there is none.
  std::optional<Span> Part(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                           Span span) const;
  // Bearings in the world that the image reaches, around `heading_rad`; all of them when the camera
  // sees straight up or down.
  Span Bearings(double heading_rad) const;

 private:
  Eigen::Vector3d centre_;
  std::array<Eigen::Vector3d, 5> inward_;   // normals of the four sides, and the optical axis
  std::array<Eigen::Vector3d, 4> corners_;  // directions
};

}  // namespace depthgrid
