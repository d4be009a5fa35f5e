#include "mapper/core/pose3.h"

namespace depthgrid {

Eigen::Quaterniond ExpRotation(const Eigen::Vector3d& rotation_vector_rad) {
  const double half_angle_rad = 0.5 * rotation_vector_rad.norm();
  // sin(x)/x, near 0 by its series, whose next term is below 1e-17.
  const double sinc = half_angle_rad < 1e-4 ? 1.0 - half_angle_rad * half_angle_rad / 6.0
                                            : std::sin(half_angle_rad) / half_angle_rad;
  const Eigen::Vector3d imaginary = 0.5 * sinc * rotation_vector_rad;
  return Eigen::Quaterniond(std::cos(half_angle_rad), imaginary.x(), imaginary.y(), imaginary.z())
      .normalized();
}

Eigen::Vector3d LogRotation(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;  // q and -q are the same rotation
  const double sine = rotation.vec().norm();
  if (sine < 1e-12) return 2.0 * sign * rotation.vec();
  return (2.0 * std::atan2(sine, sign * rotation.w()) / sine * sign) * rotation.vec();
}

double AngleOf(const Eigen::Quaterniond& rotation) {
  return 2.0 * std::atan2(rotation.vec().norm(), std::abs(rotation.w()));
}

// Wrapped here because FromTwoVectors takes some ten seconds to compile wherever it is used.
Eigen::Quaterniond RotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Pose3 Lift(const Pose2& a_from_b) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(a_from_b.yaw_rad, Eigen::Vector3d::UnitZ())),
          {a_from_b.x_m, a_from_b.y_m, 0.0}};
}

Pose3 ApplyPlanar(const Pose2& a_from_b, const Pose3& b_from_camera) {
  if (a_from_b == Pose2{}) return b_from_camera;
  return Lift(a_from_b) * b_from_camera;
}

}  // namespace depthgrid
