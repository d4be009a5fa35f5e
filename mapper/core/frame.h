// The data a source (simulation, a recorded folder, a laser log) passes to the mapper.
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

// Poses farther from the origin are refused: no point on Earth lies farther from the origin of its
// UTM zone. Indices of 5 mm cells still fit an int.
constexpr double kFarthestPoseM = 1e7;
// False for NaN.
inline bool IsWithinReach(const Eigen::Vector3d& at) {
  return (at.array().abs() <= kFarthestPoseM).all();
}
// Limit for estimates: a margin over kFarthestPoseM, as they differ from SLAM poses that drift.
constexpr double kFarthestMapM = 1.05 * kFarthestPoseM;
// False for NaN. The limit keeps cell indices within int.
inline bool IsOnAMap(const Pose2& pose) {
  return std::abs(pose.x_m) < kFarthestMapM && std::abs(pose.y_m) < kFarthestMapM &&
         std::isfinite(pose.yaw_rad);
}

// Scans must not change once given, as they may be kept; an image is not kept.
// At most one of `depth` and `scan` is set; a frame with neither carries only a pose (a missing
// image), or only loops (SLAM is lost but reports a loop).
struct Frame {
  // Position in the sequence from 0 on, counted by the source; loop closures refer to it. Numbers
  // may be skipped but not repeated.
  int index = 0;
  double stamp_s = 0.0;  // seconds from any origin; only differences matter
  std::shared_ptr<const DepthImage> depth;
  // A scan that repeats the last one exactly counts as none once the poses show that the sensor
  // moved (mapper/scan/frozen_watch.h): a driver that hangs gives its last scan again.
  std::shared_ptr<const Scan> scan;
  // With `scan` only: the scan to match, if different from `scan` (mapper/scan/frame_scans.h).
  std::shared_ptr<const Scan> matched_scan;
  // With `scan` only: the camera's tilt and height over the floor in the image that the scan was
  // made from. Empty: those of the pose.
  std::optional<CameraStand> stand;
  // SLAM's pose of the depth image: optical axes (x right, y down, z forward) in a world with z up,
  // metres (docs/conventions.md). Empty while SLAM is lost. A laser has no optical axes; to convert
  // its planar pose (x forward, y left) and back (mapper/core/level.h):
  //   frame.slam_from_camera = CameraOf(odom_from_laser);
  //   const Pose2 map_from_laser = BaseOf(*report.map_from_camera);
  //
  // A pose that repeats the last one bit for bit counts as empty once the scan or image shows that
  // the sensor moves (mapper/scan/held_watch.h): many systems that are lost repeat their last pose.
  // Not before the first pose that differs, as there may be no odometry.
  //
  // Odometry slower than the scans: give the pose at the scan's own stamp, interpolated between the
  // messages around it, if scans can wait for the next message. If not, give the last message's
  // pose again until the next one comes: at half the scans' rate or less it is moved on by the last
  // motion, and matched from there (docs/math.md, "Poses that stay"). From 5 Hz on the estimate is
  // about as good as with poses at every scan. Empty poses in between lose these frames' estimates.
  std::optional<Pose3> slam_from_camera;
  // Must change whenever SLAM corrects itself (loop closure, relocalisation): the difference of two
  // poses is a motion only within an epoch, and a jump taken for a motion bends the map
  // permanently. A step inconsistent with the previous motion (mapper/core/slam_step.h) begins an
  // epoch by itself. Unreported corrections are missed when smaller than 0.1 m + 10 m/s^2 t^2 over
  // a step of duration t; for t above a second only a jump back to the origin or first pose, and
  // one of more than 10 m and 50 m/s, are noticed. After 0.2 s and more without a pose so is any
  // after which the scan contradicts the map.
  int slam_epoch = 0;
  // Loop closures reported with this frame, applied before its pose is used.
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
  // Tolerated faults of the input (missing files, bad poses), one line each; complete after the
  // last frame.
  virtual std::vector<std::string> Warnings() const = 0;
};

}  // namespace depthgrid
