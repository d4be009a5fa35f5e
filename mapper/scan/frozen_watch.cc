#include "mapper/scan/frozen_watch.h"

#include <algorithm>

#include "mapper/core/frozen_scan.h"
#include "mapper/core/level.h"

namespace depthgrid {

bool FrozenWatch::IsFrozen(const Frame& frame) {
  if (!frame.scan || !frame.slam_from_camera) return false;
  const Pose2 slam_from_base = BaseOf(*frame.slam_from_camera);
  const bool same = frame.slam_epoch == slam_epoch_ && *frame.scan == scan_;
  if (!same) {
    scan_ = *frame.scan;
    slam_from_base_ = slam_from_base;
    stamp_s_ = frame.stamp_s;
    slam_epoch_ = frame.slam_epoch;
    return false;
  }
  const double seconds = std::max(frame.stamp_s - stamp_s_, 0.0);
  return MustDiffer(scan_, Between(slam_from_base_, slam_from_base), seconds);
}

}  // namespace depthgrid
