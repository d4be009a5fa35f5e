#include "sim/view_pyramid.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {

using Eigen::Vector3d;

ViewPyramid::ViewPyramid(const PinholeCamera& camera, const Pose3& world_from_camera)
    : centre_(world_from_camera.translation) {
  const Vector3d top_left = Unproject(camera, -0.5, -0.5, 1.0);
  const Vector3d bottom_right =
      Unproject(camera, camera.width_px - 0.5, camera.height_px - 0.5, 1.0);
  const std::array<Vector3d, 5> inward_in_camera = {
      Vector3d(1, 0, -top_left.x()), Vector3d(-1, 0, bottom_right.x()),
      Vector3d(0, 1, -top_left.y()), Vector3d(0, -1, bottom_right.y()), Vector3d(0, 0, 1)};
  for (std::size_t k = 0; k < inward_.size(); ++k) {
    inward_[k] = world_from_camera.rotation * inward_in_camera[k];
  }
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    corners_[k] =
        world_from_camera.rotation * Vector3d(k % 2 == 0 ? top_left.x() : bottom_right.x(),
                                              k / 2 == 0 ? top_left.y() : bottom_right.y(), 1.0);
  }
}

bool ViewPyramid::Holds(const Vector3d& point) const {
  return std::all_of(inward_.begin(), inward_.end(),
                     [&](const Vector3d& inward) { return inward.dot(point - centre_) >= 0.0; });
}

std::optional<Span> ViewPyramid::Part(const Vector3d& origin, const Vector3d& direction,
                                      Span span) const {
  for (const Vector3d& inward : inward_) {
    const double offset = inward.dot(origin - centre_), slope = inward.dot(direction);
    if (slope > 0.0) {
      span.low = std::max(span.low, -offset / slope);
    } else if (slope < 0.0) {
      span.high = std::min(span.high, -offset / slope);
    } else if (offset < 0.0) {
      return std::nullopt;
    }
  }
  if (span.low > span.high) return std::nullopt;
  return span;
}

Span ViewPyramid::Bearings(double heading_rad) const {
  const auto sees = [&](const Vector3d& direction) { return Holds(centre_ + direction); };
  if (sees(Vector3d::UnitZ()) || sees(-Vector3d::UnitZ())) {
    return {heading_rad - kPi, heading_rad + kPi};
  }
  Span relative;
  for (const Vector3d& corner : corners_) {
    const double angle_rad = WrapAngle(std::atan2(corner.y(), corner.x()) - heading_rad);
    relative = {std::min(relative.low, angle_rad), std::max(relative.high, angle_rad)};
  }
  return {heading_rad + relative.low, heading_rad + relative.high};
}

}  // namespace depthgrid
