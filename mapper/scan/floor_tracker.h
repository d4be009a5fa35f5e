// How the camera stands over the floor, followed from frame to frame (docs/math.md, "Height and
// tilt"): SLAM's poses drift in height, roll and pitch, the floor does not.
#pragma once

#include <optional>

#include "mapper/core/camera_stand.h"
#include "mapper/core/pose3.h"
#include "mapper/scan/floor_plane.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

class FloorTracker {
 public:
  // Where the floor was not seen yet, and only the pose says where it is, a surface this near to
  // that is the floor.
  static constexpr double kNearPoseM = 0.35;

  FloorTracker(const PinholeCamera& camera, const ScanOptions& options)
      : camera_(camera), source_(options.floor), floor_z_m_(options.floor_z_m) {}

  // The next frame. In a new epoch SLAM's poses have a new frame: only the camera's height is
  // carried over.
  CameraStand Follow(const DepthImage& image, const Pose3& slam_from_camera, int epoch);

 private:
  // The floor in the frame of SLAM's poses: height = up . position + offset.
  struct Floor {
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    double offset_m = 0.0;
  };
  CameraStand StandOver(const Floor& floor, const Pose3& slam_from_camera) const;
  // Corrects floor_ by what the image shows.
  void LookAt(const DepthImage& image, const Pose3& slam_from_camera);
  // Whether the floor may be this far below the camera, though it was expected elsewhere.
  bool Believes(double height_m, double expected_m);

  PinholeCamera camera_;
  FloorSource source_;
  double floor_z_m_;
  std::optional<int> epoch_;
  Floor floor_;        // as last seen; before that, as the poses have it
  bool seen_ = false;  // in this epoch
  // A surface where no floor was expected: how much higher, and in how many frames in a row.
  double other_higher_m_ = 0.0;
  int other_frames_ = 0;
  int looks_ = 0;
  std::optional<double> height_m_;        // of the last frame, once the floor was seen
  std::optional<double> floor_height_m_;  // of the last frame that saw it
  LevelPoints memory_;
};

}  // namespace depthgrid
