// Detects that SLAM's pose stands still: matches then say nothing about SLAM's motion noise
// (docs/math.md, "Standing still").
#pragma once

#include <optional>

#include "mapper/core/pose2.h"

namespace depthgrid {

class Standing {
 public:
  // Whether SLAM still stands if `motion` is its next motion (not added yet).
  bool After(const Pose2& motion) const;
  // `map_from_base`: where the frame was matched, if it was. A frame seen to move does not stand,
  // whatever SLAM's pose: a log may have no odometry.
  void Add(const Pose2& motion, const std::optional<Pose2>& map_from_base);
  // Call after a correction of the map: earlier matched poses are no longer comparable.
  void MapMoved() { seen_.reset(); }

 private:
  // After leaving a place it counts as moving for this many frames (a third of a second at 30 Hz),
  // because a slow motion exceeds the threshold only now and then.
  static constexpr int kMovingFrames = 10;

  Pose2 since_left_;            // SLAM's motion since it last left a place
  std::optional<Pose2> seen_;   // matched map_from_base at that time
  int frames_ = kMovingFrames;  // frames since then
};

}  // namespace depthgrid
