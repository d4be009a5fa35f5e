// Mapped frames of a planar world without any mapper, for tests of places and loops.
#pragma once

#include "mapper/core/mapped_frame.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {

// Frame `i` of a run at 30 Hz, mapped at `estimate`; both its scans are what a laser at `truth`
// sees.
inline MappedFrame MappedFrameAt(const PlanarWorld& world, const PlanarLaser& laser,
                                 const Pose2& truth, const Pose2& estimate, int i) {
  MappedFrame frame;
  frame.frame = i;
  frame.stamp_s = i / 30.0;
  frame.map_from_base = estimate;
  frame.scan = ScanArchive().Keep(ScanOf(world, truth, laser, 1, static_cast<std::uint32_t>(i)));
  frame.obstacles = frame.scan;
  return frame;
}

}  // namespace depthgrid
