#include "sim/depth/view_pyramid.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {

using Eigen::Vector3d;

ViewPyramid::ViewPyramid(const PinholeCamera& camera, const Pose3& world_from_camera,
                         const ValueSpan& depth_m)
    : centre_(world_from_camera.translation),
      axis_(world_from_camera.rotation * Vector3d::UnitZ()),
      depth_m_(depth_m) {
  const Vector3d top_left = Unproject(camera, -0.5, -0.5, 1.0);
  const Vector3d bottom_right =
      Unproject(camera, camera.width_px - 0.5, camera.height_px - 0.5, 1.0);
  const std::array<Vector3d, 4> inward_in_camera = {
      Vector3d(1, 0, -top_left.x()), Vector3d(-1, 0, bottom_right.x()),
      Vector3d(0, 1, -top_left.y()), Vector3d(0, -1, bottom_right.y())};
  for (std::size_t k = 0; k < inward_.size(); ++k) {
    inward_[k] = world_from_camera.rotation * inward_in_camera[k];
  }
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    corners_[k] =
        world_from_camera.rotation * Vector3d(k % 2 == 0 ? top_left.x() : bottom_right.x(),
                                              k / 2 == 0 ? top_left.y() : bottom_right.y(), 1.0);
  }
}

std::optional<ValueSpan> ViewPyramid::Part(const Vector3d& origin, const Vector3d& direction,
                                           ValueSpan span) const {
  // Keeps the t with offset + t * slope >= 0; false when none is left.
  const auto keep = [&span](double offset, double slope) {
    if (slope > 0.0) span.low = std::max(span.low, -offset / slope);
    if (slope < 0.0) span.high = std::min(span.high, -offset / slope);
    return span.low <= span.high && (slope != 0.0 || offset >= 0.0);
  };
  const Vector3d from_centre = origin - centre_;
  for (const Vector3d& inward : inward_) {
    if (!keep(inward.dot(from_centre), inward.dot(direction))) return std::nullopt;
  }
  const double depth_m = axis_.dot(from_centre), slope = axis_.dot(direction);
  if (!keep(depth_m - depth_m_.low, slope) || !keep(depth_m_.high - depth_m, -slope)) {
    return std::nullopt;
  }
  return span;
}

ValueSpan ViewPyramid::Bearings(double heading_rad) const {
  const auto sees = [&](const Vector3d& direction) {
    return axis_.dot(direction) > 0.0 &&
           std::all_of(inward_.begin(), inward_.end(),
                       [&](const Vector3d& inward) { return inward.dot(direction) >= 0.0; });
  };
  if (sees(Vector3d::UnitZ()) || sees(-Vector3d::UnitZ())) {
    return {heading_rad - kPi, heading_rad + kPi};
  }
  ValueSpan relative;
  for (const Vector3d& corner : corners_) {
    const double angle_rad = WrapAngle(std::atan2(corner.y(), corner.x()) - heading_rad);
    relative = {std::min(relative.low, angle_rad), std::max(relative.high, angle_rad)};
  }
  return {heading_rad + relative.low, heading_rad + relative.high};
}

}  // namespace depthgrid
