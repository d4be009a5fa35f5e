// Finds where a map leaves SLAM's path for a while, far more so than elsewhere (docs/math.md, "Led
// astray").
#pragma once

#include <vector>

#include "mapper/core/mapped_frame.h"

namespace depthgrid {

// Consecutive frames over which the poses go another way than SLAM's; indices into the vector of
// MappedFrame.
struct AstrayPart {
  int first = 0;         // the last frame before it
  int last = 0;          // its last frame
  double apart_m = 0.0;  // how far the two ways are apart, summed over steps of half a metre; a
                         // turn counts as what it moves 3 m away
  double usual_m = 0.0;  // of as many steps, by the median

  bool Overlaps(const AstrayPart& other) const { return first < other.last && other.first < last; }
};

// The parts with a step in which the two ways are `ratio` times as far apart as in the median step,
// in order of time. Frames of a prior map belong to none, nor do tied ones: their places are well
// seen. Empty for short runs.
std::vector<AstrayPart> AstrayPartsOf(const std::vector<MappedFrame>& frames, double ratio);

// All frames' poses with SLAM's motions within the part, those after it moved along.
std::vector<Pose2> FollowingSlam(const std::vector<MappedFrame>& frames, const AstrayPart& part);

}  // namespace depthgrid
