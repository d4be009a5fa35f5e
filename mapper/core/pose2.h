// SE(2): planar poses. `a_from_b * b_from_c` is a_from_c; `a_from_b * point_in_b` is point_in_a.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {

struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;  // wrapped to (-pi, pi] by every operation below

  Eigen::Vector2d translation() const { return {x_m, y_m}; }
  // (x, y, yaw) as the vector of least-squares problems.
  Eigen::Vector3d vector() const { return {x_m, y_m, yaw_rad}; }
  static Pose2 FromVector(const Eigen::Vector3d& v) { return {v.x(), v.y(), WrapAngle(v.z())}; }

  bool operator==(const Pose2&) const = default;
};

inline Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const double c = std::cos(a_from_b.yaw_rad);
  const double s = std::sin(a_from_b.yaw_rad);
  return {a_from_b.x_m + c * b_from_c.x_m - s * b_from_c.y_m,
          a_from_b.y_m + s * b_from_c.x_m + c * b_from_c.y_m,
          WrapAngle(a_from_b.yaw_rad + b_from_c.yaw_rad)};
}

inline Eigen::Vector2d operator*(const Pose2& a_from_b, const Eigen::Vector2d& point_in_b) {
  const double c = std::cos(a_from_b.yaw_rad);
  const double s = std::sin(a_from_b.yaw_rad);
  return {a_from_b.x_m + c * point_in_b.x() - s * point_in_b.y(),
          a_from_b.y_m + s * point_in_b.x() + c * point_in_b.y()};
}

inline Pose2 Inverse(const Pose2& a_from_b) {
  const double c = std::cos(a_from_b.yaw_rad);
  const double s = std::sin(a_from_b.yaw_rad);
  return {-(c * a_from_b.x_m + s * a_from_b.y_m), -(-s * a_from_b.x_m + c * a_from_b.y_m),
          WrapAngle(-a_from_b.yaw_rad)};
}

// The relative pose of Eq. 6 in its standard form, xi_i^-1 * xi_j (docs/math.md, "Pose graph").
inline Pose2 Between(const Pose2& world_from_i, const Pose2& world_from_j) {
  return Inverse(world_from_i) * world_from_j;
}

// Distance of two poses in metres plus radians: a radian counts as a metre, as it shifts points a
// metre away.
inline double Separation(const Pose2& world_from_i, const Pose2& world_from_j) {
  const Pose2 i_from_j = Between(world_from_i, world_from_j);
  return i_from_j.translation().norm() + std::abs(i_from_j.yaw_rad);
}

// Whether they differ by more than `least_m` or by more than `least_rad`.
inline bool AreApart(const Pose2& world_from_i, const Pose2& world_from_j, double least_m,
                     double least_rad) {
  const Pose2 i_from_j = Between(world_from_i, world_from_j);
  return i_from_j.translation().norm() > least_m || std::abs(i_from_j.yaw_rad) > least_rad;
}

}  // namespace depthgrid
