// A frame of a map with its scans: what a map is drawn from, saved as and gone on in.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/frame_report.h"
#include "mapper/core/kept_scan.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// A frame that was inserted, in order of time.
struct MappedFrame {
  int frame = 0;  // Frame::index; below 0: of a prior map
  double stamp_s = 0.0;
  // Where a place is well seen already, the position of the kept frame this one moves with; -1: its
  // own scans are kept. A tied frame soon loses them.
  int tied_to = -1;
  KeptScan scan;       // what is matched
  KeptScan obstacles;  // what the map is drawn from; often the same
  Pose2 map_from_base;
  // SLAM's own motion from the mapped frame before this one; empty for the first and across epochs.
  // Of a prior map's frame the motion between their final poses.
  std::optional<Pose2> slam_motion;
  // SLAM's pose stood still to here from the frame before (Standing).
  bool stands = false;
  MatchResult match;

  bool kept() const { return tied_to < 0; }
  bool of_prior_map() const { return frame < 0; }
};

inline const MappedFrame& FrameAt(const std::vector<MappedFrame>& frames, int i) {
  return frames[static_cast<std::size_t>(i)];
}

}  // namespace depthgrid
