// Detects a scan that is given again and again, exactly, while the robot moves: a driver that
// hangs. Frame by frame; of a log, whose next scans are known, mapper/io/frozen_scans.h tells more.
#pragma once

#include "mapper/core/frame.h"

namespace depthgrid {

class FrozenWatch {
 public:
  // Whether the frame's ready scan equals those before it although, by the poses since the first of
  // them, it MustDiffer() (mapper/core/frozen_scan.h). Not before the robot moved that far, and
  // never across epochs. Call once per frame, in order of time.
  bool IsFrozen(const Frame& frame);

 private:
  Scan scan_;  // a copy, as the caller may fill it again; these: of the first frame with it
  Pose2 slam_from_base_;
  double stamp_s_ = 0.0;
  int slam_epoch_ = 0;
};

}  // namespace depthgrid
