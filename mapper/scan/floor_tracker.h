// Tracks the camera's tilt and height over the floor (docs/math.md, "Height and tilt"): SLAM's
// poses drift in height, roll and pitch, the floor does not.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/camera_stand.h"
#include "mapper/core/pose3.h"
#include "mapper/scan/floor_plane.h"
#include "mapper/scan/scan_options.h"
#include "mapper/scan/stand_drift.h"
#include "mapper/scan/trodden_cells.h"

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
  // Whether the height is more than a guess: the floor was seen, or poses are to be believed.
  bool KnowsHeight() const { return source_ == FloorSource::kPose || height_m_; }

 private:
  // A plane in the frame of SLAM's poses: height = up . position + offset.
  struct Plane {
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    double offset_m = 0.0;
  };
  // One that was taken for the floor.
  struct Floor {
    Plane plane;  // as last seen; before that, from the poses
    TroddenCells trodden;
  };
  CameraStand StandOver(const Plane& plane, const Pose3& slam_from_camera) const;
  void BeginEpoch(const Pose3& slam_from_camera);
  // Updates floor_ from the image.
  void LookAt(const DepthImage& image, const Pose3& slam_from_camera);
  // What of the image is the floor, if anything is; may leave floor_ for another surface.
  std::optional<FloorPlane> FindFloor(const Pose3& slam_from_camera, const CameraStand& expected);
  // The plane of the surface that is followed, at about the expected height. `usual_up`: its usual
  // normal, in the axes of the level points.
  std::optional<FloorPlane> Followed(const LevelSurface& surface, double expected_m,
                                     const Eigen::Vector3d& usual_up);
  // The plane of a surface at an unexpected height, if only SLAM's tilt made it one: with the tilt
  // that it shows, the camera is as high above it as expected.
  std::optional<FloorPlane> TiltedFloor(const LevelSurface& surface, double expected_m) const;
  // Whether the camera has passed over the floor.
  bool Stands() const;
  // Whether the camera is as high as when the floor was seen last, and SLAM, which says otherwise,
  // can have drifted by that much meanwhile.
  bool IsAsLastSeen(double height_m, double expected_m) const;
  // Whether a plane this far below the camera can be the floor, by what SLAM can have drifted since
  // that was seen last.
  bool IsAsHigh(double height_m, double expected_m) const;
  // Counts how often in a row a surface was seen at an unexpected height; whether that is now often
  // enough to take it for the floor. `expected_m` of the floor, `posed_m` if the poses are right.
  bool IsBelieved(double height_m, double expected_m, double posed_m);
  // Goes back to what was taken for the floor before if that is in view and more likely; whether it
  // did.
  bool GoBack(const LevelSurface* own, const Pose3& slam_from_camera, double expected_m);
  void Leave();  // keeps the floor in mind as what was taken for it before
  // Where the image shows what is and what was taken for the floor.
  void Note(const Pose3& slam_from_camera, const Eigen::Quaterniond& slam_from_level);

  PinholeCamera camera_;
  FloorSource source_;
  double floor_z_m_;
  std::optional<int> epoch_;
  Floor floor_;
  Eigen::Vector3d usual_up_ = Eigen::Vector3d::UnitZ();  // of the floor, in SLAM's frame
  bool seen_ = false;                                    // in this epoch
  double posed_offset_m_ = 0.0;                          // the plane's at the epoch's beginning
  double posed_off_m_ = 0.0;              // how far the floor was off from it when it was taken
  std::optional<Floor> left_;             // what was taken for the floor before
  int left_frames_ = 0, left_since_ = 0;  // frames in a row it is in view; since it was left
  Floor other_;                           // a surface at an unexpected height, seen in
  int other_frames_ = 0;                  // so many frames in a row
  int looks_ = 0;
  std::optional<double> height_m_;  // camera height of the last frame, once the floor was seen
  std::optional<double> floor_height_m_;  // camera height of the last frame that saw the floor
  StandDrift drift_;
  LevelPoints memory_;
  std::vector<LevelSurface> surfaces_;  // of the last image
};

}  // namespace depthgrid
