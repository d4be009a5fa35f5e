// The two scans of a frame. Obstacles are the nearest surface in the whole obstacle band; but which
// surface that is changes with the camera's tilt and distance (a table top leaves the image when
// the camera comes near), so such scans are not rigid. A thin level slice at the camera's height,
// the paper's "horizontal point cloud", is visible at any distance and is matched instead. If the
// image looks below the horizon, it shows next to nothing of that slice; then one just above the
// floor is matched, or the obstacles where the floor is not known.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/core/slam_epochs.h"
#include "mapper/scan/depth_to_scan.h"
#include "mapper/scan/floor_tracker.h"

namespace depthgrid {

struct FrameScans {
  std::shared_ptr<const Scan> obstacles;  // what the map is drawn from; null without an image
  std::shared_ptr<const Scan> matched;    // the scan to match; may be the same object
  std::optional<CameraStand> stand = {};  // of depth images and scans made from them
  // `matched` without what was not seen to stand (MovingObjects); null if all of it stands.
  std::shared_ptr<const Scan> standing = {};

  // The scan that enters the map.
  const std::shared_ptr<const Scan>& kept() const { return standing ? standing : matched; }
};

// Reuses scans that nobody else holds any more.
class ScanPool {
 public:
  std::shared_ptr<Scan> Take();

 private:
  std::vector<std::shared_ptr<Scan>> scans_;
};

class FrameScanner {
 public:
  // The camera may be absent when every frame brings a ready scan.
  FrameScanner(const std::optional<PinholeCamera>& camera, const ScanOptions& options);

  // A ready scan is copied, so that the caller may change it: beams sorted by bearing, without
  // those that are not finite, start behind the sensor, or hit nearer than 1 mm or beyond
  // max_range_m; free space is limited to that range. If max_range_m is 0 or 1 km and more, 250 m
  // is used, and beams without a hit that clear farther are ignored. Its stand is the frame's. A
  // depth image without a pose gives no scans; a ready scan needs no pose. Call in order of frames,
  // as the floor is tracked.
  FrameScans ScansOf(const Frame& frame);

 private:
  std::shared_ptr<const Scan> SoundPart(const Scan& given);
  // The slice to match: around the camera's height, or, where the image looks below that, above the
  // floor. As the band of obstacles does, it ends above the floor, which a robot's camera may have
  // closer below it than the half height: noise makes hits of it that move along.
  SliceHeights SliceOf(const CameraStand& stand) const;

  SlamEpochs epochs_;
  PinholeCamera camera_;
  std::optional<DepthToScan> converter_;
  std::optional<FloorTracker> floor_;
  double slice_half_height_m_ = 0.0;  // 0: the obstacle scan itself is matched
  double band_low_m_ = 0.0;
  bool drop_cut_ends_ = false;
  double farthest_m_ = 0.0;  // largest NoiseWindow::farthest_m() so far
  ScanMemory memory_;
  ScanPool pool_;
};

}  // namespace depthgrid
