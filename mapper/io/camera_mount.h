// Where a camera is on the body (an IMU, a robot) whose poses a recording gives.
#pragma once

#include <string>

#include "mapper/core/slam_output.h"
#include "mapper/io/config.h"

namespace depthgrid {

struct CameraMount {
  Pose3 body_from_camera;
  std::string stated_as;  // the file and the key in it: "camchain.yaml (cam0.T_cam_imu)"
};

// The camera's pose on the body by a file of another program: EuRoC's T_BS, VINS-Fusion's
// body_T_cam0, ORB-SLAM3's IMU.T_b_c1 or Tbc, Kalibr's T_imu_cam and, inverted, T_cam_imu, also of
// the first camera of a chain; or a text with a matrix, body from camera. Throws InputError.
CameraMount ReadCameraMount(const std::string& path);
CameraMount ParseCameraMount(const std::string& text, const std::string& place);

// The first of these keys in a camera file, "cam0.T_cam_imu"; empty if it has none.
std::string MountKeyIn(Config config);

// "the camera's poses are those given times its own on the body, ...".
std::string Said(const CameraMount& mount);

Pose3 OnBody(const Pose3& world_from_body, const CameraMount& mount);
// The camera's poses of those of the body.
Trajectory OnBody(Trajectory poses, const CameraMount& mount);
SlamOutput OnBody(SlamOutput slam, const CameraMount& mount);

}  // namespace depthgrid
