#include "mapper/core/pose3.h"

namespace depthgrid {

Pose3 Lift(const Pose2& a_from_b) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(a_from_b.yaw_rad, Eigen::Vector3d::UnitZ())),
          {a_from_b.x_m, a_from_b.y_m, 0.0}};
}

Pose3 ApplyPlanar(const Pose2& a_from_b, const Pose3& b_from_camera) {
  if (a_from_b == Pose2{}) return b_from_camera;
  return Lift(a_from_b) * b_from_camera;
}

}  // namespace depthgrid
