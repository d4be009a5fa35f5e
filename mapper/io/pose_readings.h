// What poses and cameras become when they are read as something else than they were.
#pragma once

#include <Eigen/Core>

#include "mapper/core/camera.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// Rows are t x y z qw qx qy qz.
Pose3 WithWFirst(const Pose3& pose);
// Of a robot's axes at the camera: x forward, y left, z up.
Pose3 FromBodyAxes(const Pose3& pose);
// Of other axes at the camera than its own. Where `camera_from_own` mirrors, their world is a
// mirror image too, and any one of it does.
Pose3 FromAxes(const Pose3& pose, const Eigen::Matrix3d& camera_from_own);
// The camera looks so far below the axes' forward direction.
Pose3 LookingDown(const Pose3& pose, double down_rad);

PinholeCamera WithFocal(PinholeCamera camera, double scale);
PinholeCamera WithCentre(PinholeCamera camera, const Eigen::Vector2d& centre_px);
// The image's corner, half a pixel before the middle of the first, stays where it is.
PinholeCamera OfImageSize(PinholeCamera camera, double scale);

}  // namespace depthgrid
