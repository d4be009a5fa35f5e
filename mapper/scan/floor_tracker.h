// Tracks the camera's tilt and height over the floor (docs/math.md, "Height and tilt"): SLAM's
// poses drift in height, roll and pitch, the floor does not.
#pragma once

#include <optional>

#include "mapper/core/camera_stand.h"
#include "mapper/core/pose3.h"
#include "mapper/scan/floor_plane.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

class FloorTracker {
 public:
  // Before the floor was seen, a surface this near to where the pose puts the floor is taken for
  // it.
  static constexpr double kNearPoseM = 0.35;

  FloorTracker(const PinholeCamera& camera, const ScanOptions& options)
      : camera_(camera), source_(options.floor), floor_z_m_(options.floor_z_m) {}

  // Processes the next frame. In a new epoch, whose poses have another frame, only the camera's
  // height is kept.
  CameraStand Follow(const DepthImage& image, const Pose3& slam_from_camera, int epoch);

 private:
  // The floor in the frame of SLAM's poses: height = up . position + offset.
  struct Floor {
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    double offset_m = 0.0;
  };
  CameraStand StandOver(const Floor& floor, const Pose3& slam_from_camera) const;
  // The plane of a surface at an unexpected height, if only SLAM's tilt made it one: with the tilt
  // that it shows, the camera is as high above it as expected.
  std::optional<FloorPlane> TiltedFloor(const FloorPrior& prior, double expected_m);
  // Updates floor_ from the image.
  void LookAt(const DepthImage& image, const Pose3& slam_from_camera);
  // Whether a surface at this height is the floor: as far below the camera as expected, or as when
  // it was seen last, whatever height SLAM has drifted to meanwhile.
  bool IsExpected(double height_m, double expected_m, double near_m) const;
  // Whether a surface at this height is accepted as the floor; counts how often one was seen at an
  // unexpected height.
  bool AcceptOrCount(double height_m, double expected_m);

  PinholeCamera camera_;
  FloorSource source_;
  double floor_z_m_;
  std::optional<int> epoch_;
  Floor floor_;        // as last seen; before that, from the poses
  bool seen_ = false;  // in this epoch
  // A surface at an unexpected height: how much higher, and for how many consecutive frames.
  double other_higher_m_ = 0.0;
  int other_frames_ = 0;
  int looks_ = 0;
  std::optional<double> height_m_;  // camera height of the last frame, once the floor was seen
  std::optional<double> floor_height_m_;  // camera height of the last frame that saw the floor
  LevelPoints memory_;
};

}  // namespace depthgrid
