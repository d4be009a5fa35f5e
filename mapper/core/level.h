// The planar frame under a camera: the origin of `base` is the camera centre projected to the floor
// plane, its x axis the horizontal projection of the optical axis (of the image's up direction when
// the optical axis is within 10 degrees of vertical), z up. Camera axes are optical: x right, y
// down, z forward.
#pragma once

#include "mapper/core/pose3.h"

namespace depthgrid {

// The heading of an optical axis closer than this to vertical is ill-defined; the image's up
// direction is used instead.
constexpr double kVerticalAxisLimitRad = RadFromDeg(10.0);

// world_from_base of a camera whose world has z up.
Pose2 BaseOf(const Pose3& world_from_camera);

// The same for a pose given in base axes, as in laser logs: its rotation is about z only.
Pose2 PlanarPoseOf(const Pose3& world_from_base);

// The rotation that levels the camera: level_from_camera, where `level` has base's heading, z up
// and the camera's centre as origin. Multiplying a point in camera axes gives (forward, left, up)
// in metres from the camera.
Eigen::Quaterniond LevelFromCamera(const Pose3& world_from_camera);

// A level camera looking along base's x axis from the given height: the inverse of BaseOf for
// planar sensors, whose ready scans do not depend on the height.
Pose3 CameraOf(const Pose2& world_from_base, double height_m = 0.0);

// Whether the optical axis is so near to vertical that BaseOf takes the image's up direction.
bool LooksUpOrDown(const Pose3& world_from_camera);

// A relative camera pose i_from_j projected to SE(2) through both cameras' level rotations:
// base_i_from_base_j.
Pose2 ProjectRelative(const Pose3& world_from_camera_i, const Pose3& world_from_camera_j,
                      const Pose3& camera_i_from_camera_j);

}  // namespace depthgrid
