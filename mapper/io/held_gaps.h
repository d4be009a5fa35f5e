// Poses for frames whose own pose is not believed, as it is that of an earlier frame.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/core/pose3.h"
#include "mapper/io/frame_part.h"

namespace depthgrid {

struct TimedPose {
  double stamp_s = 0.0;
  std::optional<Pose3> pose;
  int epoch = 0;
};

// Frames from `begin` to before `end` whose poses were held.
struct HeldGap {
  std::size_t begin = 0, end = 0;
  bool is_interpolated = false;  // false: they have no pose
};

struct MendedPoses {
  std::vector<std::optional<Pose3>> poses;
  std::vector<HeldGap> gaps;
};

// Interpolates the poses of held frames between those before and after them, by stamp, the position
// linearly and along the shortest turn, if these two differ, are of one epoch and near in time and
// place; else removes them.
MendedPoses MendHeld(const std::vector<TimedPose>& frames, const std::vector<bool>& held);

// Held frames of a part.
struct HeldCount {
  std::optional<std::size_t> first;  // empty: none
  std::size_t interpolated = 0, lost = 0;
};
HeldCount CountHeld(const std::vector<HeldGap>& gaps, const FramePart& part);

}  // namespace depthgrid
