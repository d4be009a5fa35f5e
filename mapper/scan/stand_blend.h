// The camera's height and tilt in the map, from what SLAM's pose says of them and from the floor
// that is followed in the images (docs/math.md, "Height and tilt").
#pragma once

#include "mapper/core/camera_stand.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

class StandBlend {
 public:
  explicit StandBlend(double floor_z_m) : floor_z_m_(floor_z_m) {}

  // What both say of a frame.
  void Add(const Pose3& slam_from_camera, const CameraStand& over_floor);

  // The pose moved in height and turned in roll and pitch towards `over_floor`, as far as SLAM was
  // seen to drift; its base stays. The pose itself where SLAM does not err by more than the floor.
  Pose3 Placed(const Pose3& map_from_camera, const CameraStand& over_floor) const;

 private:
  double floor_z_m_;
  int frames_ = 0;
  double height_square_m2_ = 0.0;  // sums over the frames, of how far the two differ
  double tilt_square_rad2_ = 0.0;
};

}  // namespace depthgrid
