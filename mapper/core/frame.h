// All that crosses from a source (simulation, a recorded folder, a laser log) to the mapper.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/camera_stand.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/scan.h"
#include "mapper/core/slam_output.h"

namespace depthgrid {

// Farther from the origin a pose is wrong: on Earth, in metres, nothing lies farther from the
// origin of its UTM zone. Cells of 5 mm are still numbered.
constexpr double kFarthestPoseM = 1e7;
// False for NaN.
inline bool IsWithinReach(const Eigen::Vector3d& at) {
  return (at.array().abs() <= kFarthestPoseM).all();
}
// Nor does the map lie farther, with room for how far an estimate goes from poses that drift.
constexpr double kFarthestMapM = 1.05 * kFarthestPoseM;
// False for NaN too. The limit keeps cell indices within int.
inline bool IsOnAMap(const Pose2& pose) {
  return std::abs(pose.x_m) < kFarthestMapM && std::abs(pose.y_m) < kFarthestMapM &&
         std::isfinite(pose.yaw_rad);
}

// At most one of `depth` and `scan` is set; a frame with neither carries a pose only (a missing
// image), or only loops (SLAM is lost, and yet corrected itself).
struct Frame {
  // Position in the sequence from 0 on, counted by the source; loop closures refer to it. Numbers
  // may be left out, none comes twice.
  int index = 0;
  double stamp_s = 0.0;  // seconds since whenever; differences are what counts
  std::shared_ptr<const DepthImage> depth;
  std::shared_ptr<const Scan> scan;
  // With `scan` only: what is matched where that is another one (mapper/scan/frame_scans.h).
  std::shared_ptr<const Scan> matched_scan;
  // With `scan` only: how the camera stood over the floor seen in the image that the scan was made
  // from. Empty: as the pose has it.
  std::optional<CameraStand> stand;
  // SLAM's pose of the depth image: optical axes (x right, y down, z forward) in a world with z up,
  // metres (docs/conventions.md). Empty while SLAM is lost. A laser has no optical axes; with its
  // planar pose (x forward, y left), and back (mapper/core/level.h):
  //   frame.slam_from_camera = CameraOf(odom_from_laser);
  //   const Pose2 map_from_laser = BaseOf(*report.map_from_camera);
  std::optional<Pose3> slam_from_camera;
  // Another number whenever SLAM corrected itself (a loop closed, relocalised): the difference of
  // two poses is a motion only within an epoch, and a jump that is taken for one bends the map for
  // good. A step that the motion before does not lead to (mapper/core/slam_step.h) begins one by
  // itself; corrections of less than 0.1 m go unseen, and of less than 0.1 m + 10 m/s^2 t^2 over a
  // step that takes t, up to a second; over more, all but one back to the origin.
  int slam_epoch = 0;
  // Reported with this frame, to be applied before its pose is used.
  std::vector<LoopClosure> loops;
};

// A sequence read once from front to back.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // The next frame, or nothing at the end.
  virtual std::optional<Frame> Next() = 0;
  // The camera of the depth images; nothing for sources of ready scans.
  virtual std::optional<PinholeCamera> Camera() const = 0;
  // How many frames Next() will give in all, for progress bars.
  virtual int FrameCount() const = 0;
  // What was wrong with the input and survived (missing files, bad poses), one line each, complete
  // at the end.
  virtual std::vector<std::string> Warnings() const = 0;
};

}  // namespace depthgrid
