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
  // whatever SLAM's pose: a log may have no odometry. But if SLAM's pose ever moved, that must be
  // seen for several frames: people who walk away from before a robot draw the match along.
  void Add(const Pose2& motion, const std::optional<Pose2>& map_from_base);
  // Call after a correction of the map: earlier matched poses are no longer comparable.
  void MapMoved() {
    seen_.reset();
    elsewhere_ = 0;
  }

 private:
  // After leaving a place it counts as moving for this many frames (a third of a second at 30 Hz),
  // because a slow motion exceeds the threshold only now and then.
  static constexpr int kMovingFrames = 10;

  Pose2 since_left_;            // SLAM's motion since it last left a place
  std::optional<Pose2> seen_;   // matched map_from_base at that time
  int frames_ = kMovingFrames;  // frames since then
  int elsewhere_ = 0;           // the last frames in a row that were matched away from seen_
  bool ever_left_ = false;      // whether SLAM's pose ever left a place
};

}  // namespace depthgrid
