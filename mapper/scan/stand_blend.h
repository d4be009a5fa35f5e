// Blends the camera's height and tilt from SLAM's pose with those over the tracked floor
// (docs/math.md, "Height and tilt").
#pragma once

#include "mapper/core/camera_stand.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

class StandBlend {
 public:
  explicit StandBlend(double floor_z_m) : floor_z_m_(floor_z_m) {}

  // Adds a frame's pose and stand.
  void Add(const Pose3& slam_from_camera, const CameraStand& over_floor);

  // The pose with height, roll and pitch moved towards `over_floor` in proportion to SLAM's drift;
  // its base does not change. The pose itself if SLAM's errors do not exceed the floor's.
  Pose3 Placed(const Pose3& map_from_camera, const CameraStand& over_floor) const;

 private:
  double floor_z_m_;
  int frames_ = 0;
  double height_square_m2_ = 0.0;  // sums over the frames of squared differences
  double tilt_square_rad2_ = 0.0;
};

}  // namespace depthgrid
