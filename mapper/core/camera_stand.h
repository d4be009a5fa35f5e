// Tilt and height of a camera above the floor: the part of its pose that a level scan needs.
#pragma once

#include <Eigen/Geometry>

#include "mapper/core/level.h"

namespace depthgrid {

struct CameraStand {
  Eigen::Quaterniond level_from_camera = Eigen::Quaterniond::Identity();
  double height_m = 0.0;  // of the camera's centre above the floor
};

// According to SLAM's pose alone, without looking at the floor.
inline CameraStand StandOf(const Pose3& slam_from_camera, double floor_z_m) {
  return {LevelFromCamera(slam_from_camera), slam_from_camera.translation.z() - floor_z_m};
}

}  // namespace depthgrid
