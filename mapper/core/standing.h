// Whether SLAM's pose stands still: what is seen then says nothing of how SLAM errs when it moves
// (docs/math.md, "Standing still").
#pragma once

#include <optional>

#include "mapper/core/pose2.h"

namespace depthgrid {

class Standing {
 public:
  // Whether SLAM stands after this motion, the next one.
  bool After(const Pose2& motion) const;
  // `map_from_base`: where the frame was matched, if it was. One that is seen to move does not
  // stand, whatever SLAM says: a log may have no odometry.
  void Add(const Pose2& motion, const std::optional<Pose2>& map_from_base);
  // The map was corrected: frames matched before lie elsewhere.
  void MapMoved() { seen_.reset(); }

 private:
  // It moves for so many frames from one that left where SLAM was, a third of a second at 30 Hz:
  // slow motions leave it now and then.
  static constexpr int kMovingFrames = 10;

  Pose2 since_left_;            // SLAM's motion since it left a place last
  std::optional<Pose2> seen_;   // where it was seen to be then
  int frames_ = kMovingFrames;  // since then
};

}  // namespace depthgrid
