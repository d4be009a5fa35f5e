// The two scans of a frame. What a robot must not run into is the nearest surface anywhere in the
// obstacle band; but which surface that is changes with the camera's tilt and distance (a table top
// leaves the image when the camera comes near), so such scans do not fit each other rigidly. A thin
// level slice at the camera's own height is seen at any distance and is the paper's "horizontal
// point cloud": that is what is matched. An image that looks below the horizon shows next to
// nothing of it, and its obstacles are matched.
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
  std::shared_ptr<const Scan> matched;  // what is matched; the same object where there is one scan
  std::optional<CameraStand> stand = {};  // of depth images, and of scans made from such
  // What of `matched` was seen to stand where that is not all (MovingObjects), else null.
  std::shared_ptr<const Scan> standing = {};

  // What becomes part of what later scans are matched against.
  const std::shared_ptr<const Scan>& kept() const { return standing ? standing : matched; }
};

// Scans that are written again once nobody else holds them.
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

  // Of a ready scan both are a copy of it, so that the caller's may change: its beams in order of
  // bearing, less those that say nothing, as they are not finite, start behind the sensor, or hit
  // nearer than 1 mm or beyond the scan's reach, and clear no farther than that. Where it does not
  // tell its reach that is 1 km, and a beam without a hit that clears farther says nothing either.
  // The stand is the one that came with it. A depth image without a pose gives neither; a ready
  // scan needs none. Frames come in order: the floor is followed from one to the next.
  FrameScans ScansOf(const Frame& frame);

 private:
  std::shared_ptr<const Scan> SoundPart(const Scan& given);

  SlamEpochs epochs_;
  std::optional<DepthToScan> converter_;
  std::optional<FloorTracker> floor_;
  double slice_half_height_m_ = 0.0;  // 0: the obstacle scan itself is matched
  bool drop_cut_ends_ = false;
  double farthest_m_ = 0.0;  // NoiseWindow's, of any image
  ScanMemory memory_;
  ScanPool pool_;
};

}  // namespace depthgrid
