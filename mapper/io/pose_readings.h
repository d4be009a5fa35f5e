// Poses and cameras under other interpretations (pose_check.h).
#pragma once

#include <Eigen/Core>

#include "mapper/core/camera.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// For rows of t x y z qw qx qy qz.
Pose3 WithWFirst(const Pose3& pose);
// For rows of t x y z qx qy qz qw that were read as the former.
Pose3 WithWLast(const Pose3& pose);
// For poses of robot axes at the camera: x forward, y left, z up.
Pose3 FromBodyAxes(const Pose3& pose);
// For poses of other axes at the camera. If `camera_from_own` is a reflection, their world is
// mirrored too; any mirror image of it will do.
Pose3 FromAxes(const Pose3& pose, const Eigen::Matrix3d& camera_from_own);
// For a camera pitched down by `down_rad` from the axes' forward direction.
Pose3 LookingDown(const Pose3& pose, double down_rad);

PinholeCamera WithFocal(PinholeCamera camera, double scale);
PinholeCamera WithCentre(PinholeCamera camera, const Eigen::Vector2d& centre_px);
// Scales the intrinsics about the image's corner (-0.5, -0.5).
PinholeCamera OfImageSize(PinholeCamera camera, double scale);

}  // namespace depthgrid
