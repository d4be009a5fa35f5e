// A short piece of wall: a point that is known along its normal only.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "mapper/core/pose2.h"

namespace depthgrid {

// In the axes of a scan, of a group of frames, or of the map. The normal points to the free side,
// where the sensor was, so the two sides of a wall never mix.
struct Surfel {
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double information = 0.0;         // of the point along the normal, 1/m^2
  double normal_information = 0.0;  // of the normal's direction, 1/rad^2
};

// Signed distance of the point from the surfel's line, positive on the free side.
inline double OffsetFrom(const Surfel& surfel, const Eigen::Vector2d& point_m) {
  return surfel.normal.dot(point_m - surfel.point_m);
}

// A pose with precomputed sine and cosine, for many points.
struct Motion2 {
  explicit Motion2(const Pose2& pose)
      : cosine(std::cos(pose.yaw_rad)), sine(std::sin(pose.yaw_rad)), shift_m(pose.translation()) {}

  Eigen::Vector2d Turn(const Eigen::Vector2d& v) const {
    return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y()};
  }
  Eigen::Vector2d TurnBack(const Eigen::Vector2d& v) const {
    return {cosine * v.x() + sine * v.y(), -sine * v.x() + cosine * v.y()};
  }
  Eigen::Vector2d operator*(const Eigen::Vector2d& point_m) const {
    return Turn(point_m) + shift_m;
  }
  Surfel operator*(const Surfel& surfel) const {
    Surfel moved = surfel;
    moved.point_m = *this * surfel.point_m;
    moved.normal = Turn(surfel.normal);
    return moved;
  }

  double cosine;
  double sine;
  Eigen::Vector2d shift_m;
};

// The derivative of a surfel's offset by a small motion (forward, left, yaw) of the axes that
// `point` is given in; `direction` is the surfel's normal in the same axes.
inline Eigen::Vector3d OffsetJacobian(const Eigen::Vector2d& direction,
                                      const Eigen::Vector2d& point_m) {
  return {direction.x(), direction.y(), direction.y() * point_m.x() - direction.x() * point_m.y()};
}

}  // namespace depthgrid
