#include "mapper/io/pose_readings.h"

#include "mapper/core/level.h"

namespace depthgrid {

Pose3 WithWFirst(const Pose3& pose) {
  const Eigen::Quaterniond& q = pose.rotation;  // x y z w as read hold w x y z
  return {Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
}

Pose3 WithWLast(const Pose3& pose) {
  const Eigen::Quaterniond& q = pose.rotation;  // w x y z as read hold x y z w
  return {Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()), pose.translation};
}

Pose3 FromBodyAxes(const Pose3& pose) {
  const Eigen::Quaterniond body_from_camera = CameraOf(Pose2{}, 0.0).rotation;
  return {pose.rotation * body_from_camera, pose.translation};
}

Pose3 FromAxes(const Pose3& pose, const Eigen::Matrix3d& camera_from_own) {
  const double mirror = camera_from_own.determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d rotation =
      mirror * pose.rotation.toRotationMatrix() * camera_from_own.transpose();
  return {Eigen::Quaterniond(rotation), mirror * pose.translation};
}

Pose3 LookingDown(const Pose3& pose, double down_rad) {
  const Eigen::AngleAxisd down(-down_rad, Eigen::Vector3d::UnitX());
  return {pose.rotation * Eigen::Quaterniond(down), pose.translation};
}

PinholeCamera WithFocal(PinholeCamera camera, double scale) {
  camera.fx_px *= scale;
  camera.fy_px *= scale;
  return camera;
}

PinholeCamera WithCentre(PinholeCamera camera, const Eigen::Vector2d& centre_px) {
  camera.cx_px = centre_px.x();
  camera.cy_px = centre_px.y();
  return camera;
}

PinholeCamera OfImageSize(PinholeCamera camera, double scale) {
  camera = WithFocal(camera, scale);
  camera.cx_px = scale * (camera.cx_px + 0.5) - 0.5;
  camera.cy_px = scale * (camera.cy_px + 0.5) - 0.5;
  return camera;
}

}  // namespace depthgrid
