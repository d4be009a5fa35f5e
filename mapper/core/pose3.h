// SE(3): poses of the camera. `a_from_b * b_from_c` is a_from_c; `a_from_b * point_in_b` is
// point_in_a.
#pragma once

#include <Eigen/Geometry>

#include "mapper/core/pose2.h"

namespace depthgrid {

struct Pose3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // unit norm
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         // metres

  bool operator==(const Pose3& other) const {
    return rotation.coeffs() == other.rotation.coeffs() && translation == other.translation;
  }
};

inline Pose3 operator*(const Pose3& a_from_b, const Pose3& b_from_c) {
  return {(a_from_b.rotation * b_from_c.rotation).normalized(),
          a_from_b.translation + a_from_b.rotation * b_from_c.translation};
}

inline Eigen::Vector3d operator*(const Pose3& a_from_b, const Eigen::Vector3d& point_in_b) {
  return a_from_b.translation + a_from_b.rotation * point_in_b;
}

inline Pose3 Inverse(const Pose3& a_from_b) {
  const Eigen::Quaterniond b_from_a = a_from_b.rotation.conjugate();
  return {b_from_a, -(b_from_a * a_from_b.translation)};
}

inline Pose3 Between(const Pose3& world_from_i, const Pose3& world_from_j) {
  return Inverse(world_from_i) * world_from_j;
}

// The rotation by |v| about v, and its inverse, whose length is in [0, pi].
Eigen::Quaterniond ExpRotation(const Eigen::Vector3d& rotation_vector_rad);
Eigen::Vector3d LogRotation(const Eigen::Quaterniond& rotation);
// The length of that, of a unit quaternion; accurate for small angles, where acos of the trace is
// not.
double AngleOf(const Eigen::Quaterniond& rotation);

// The smallest rotation that takes the direction of `from` to that of `to`, neither of them zero;
// about any perpendicular axis if they are opposite.
Eigen::Quaterniond RotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// A planar pose as a 6-DoF pose with z = 0 and rotation about z.
Pose3 Lift(const Pose2& a_from_b);

// A planar correction applied to a camera pose: z, roll and pitch stay those of the camera pose.
// The identity correction returns its argument bit for bit (K = 0 must give the SLAM poses back).
Pose3 ApplyPlanar(const Pose2& a_from_b, const Pose3& b_from_camera);

}  // namespace depthgrid
