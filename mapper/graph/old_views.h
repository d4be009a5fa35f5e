// Which of the frames mapped before saw what others see now.
#pragma once

#include <vector>

#include "mapper/core/mapped_frame.h"
#include "mapper/graph/loop_overlap.h"

namespace depthgrid {

// Range at which surfaces are seen from a place: how far beyond it old frames are looked for.
constexpr double kSightM = 6.0;

// Positions of frames from `begin` to before `end` within `reach_m` of a pose that together show
// what can be seen there: those with a scan, thinned.
std::vector<int> ViewsWithin(const std::vector<MappedFrame>& frames, int begin, int end,
                             const Pose2& around, double reach_m);

// The same from the first frame on.
inline std::vector<int> OldFrames(const std::vector<MappedFrame>& frames, int end,
                                  const Pose2& around, double reach_m) {
  return ViewsWithin(frames, 0, end, around, reach_m);
}

// Of these the nearest to each member once that is moved by `shift` (map axes): they looked at what
// the members see. In order.
std::vector<int> SeenFromNear(const std::vector<MappedFrame>& frames, const std::vector<int>& old,
                              const std::vector<int>& members, const Pose2& shift);

// How the last frame (the second place) agrees, at its pose, with what those before it (the first)
// saw from anywhere near.
OverlapEachWay OverlapOfNewest(const std::vector<MappedFrame>& frames,
                               const OverlapOptions& options);

}  // namespace depthgrid
