#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// For a level camera optical z is level x (forward), optical x is level -y, optical y is level -z.
Eigen::Quaterniond LevelFromOptical() {
  Eigen::Matrix3d level_from_optical;
  level_from_optical << 0, 0, 1,  //
      -1, 0, 0,                   //
      0, -1, 0;
  return Eigen::Quaterniond(level_from_optical);
}

bool IsNearVertical(const Eigen::Vector3d& axis_in_world) {
  return std::hypot(axis_in_world.x(), axis_in_world.y()) < std::sin(kVerticalAxisLimitRad);
}

double HeadingOf(const Eigen::Quaterniond& world_from_camera) {
  const Eigen::Vector3d axis_in_world = world_from_camera * Eigen::Vector3d::UnitZ();
  if (!IsNearVertical(axis_in_world)) {
    return std::atan2(axis_in_world.y(), axis_in_world.x());
  }
  // Looking down, the image's up direction points ahead; looking up, it points behind.
  const double sign = axis_in_world.z() < 0.0 ? 1.0 : -1.0;
  const Eigen::Vector3d up_in_world = sign * (world_from_camera * -Eigen::Vector3d::UnitY());
  return std::atan2(up_in_world.y(), up_in_world.x());
}

}  // namespace

Pose2 BaseOf(const Pose3& world_from_camera) {
  return {world_from_camera.translation.x(), world_from_camera.translation.y(),
          HeadingOf(world_from_camera.rotation)};
}

Pose2 PlanarPoseOf(const Pose3& world_from_base) {
  const Eigen::Vector3d& at_m = world_from_base.translation;
  const Eigen::Quaterniond& q = world_from_base.rotation;
  return {at_m.x(), at_m.y(), WrapAngle(2.0 * std::atan2(q.z(), q.w()))};
}

Eigen::Quaterniond LevelFromCamera(const Pose3& world_from_camera) {
  const Eigen::Quaterniond level_from_world(
      Eigen::AngleAxisd(-HeadingOf(world_from_camera.rotation), Eigen::Vector3d::UnitZ()));
  return (level_from_world * world_from_camera.rotation).normalized();
}

bool LooksUpOrDown(const Pose3& world_from_camera) {
  return IsNearVertical(world_from_camera.rotation * Eigen::Vector3d::UnitZ());
}

Pose3 CameraOf(const Pose2& world_from_base, double height_m) {
  const Eigen::Quaterniond world_from_level(
      Eigen::AngleAxisd(world_from_base.yaw_rad, Eigen::Vector3d::UnitZ()));
  return {(world_from_level * LevelFromOptical()).normalized(),
          {world_from_base.x_m, world_from_base.y_m, height_m}};
}

Pose2 ProjectRelative(const Pose3& world_from_camera_i, const Pose3& world_from_camera_j,
                      const Pose3& camera_i_from_camera_j) {
  const Eigen::Quaterniond level_from_i = LevelFromCamera(world_from_camera_i);
  const Eigen::Quaterniond j_from_level = LevelFromCamera(world_from_camera_j).conjugate();
  const Eigen::Vector3d shift = level_from_i * camera_i_from_camera_j.translation;
  const Eigen::Vector3d heading =
      level_from_i * (camera_i_from_camera_j.rotation * (j_from_level * Eigen::Vector3d::UnitX()));
  return {shift.x(), shift.y(), std::atan2(heading.y(), heading.x())};
}

}  // namespace depthgrid
