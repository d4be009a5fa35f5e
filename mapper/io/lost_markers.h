// Poses that a tracker gives while it is lost: the identity, far from those before and after.
#pragma once

#include <vector>

#include "mapper/core/slam_output.h"

namespace depthgrid {

// Indices in `live` of identities into which the poses jump and, unless they are the last, out of
// which they jump again. A tracker that begins anew at the identity goes on from there, and one
// that begins there did not jump.
// `identity`: what the identity has become, where poses were converted since they were given.
std::vector<int> FindLostMarkers(const std::vector<SlamPose>& live, const Pose3& identity = {});

// What a warning says of their number.
inline constexpr const char* kLostMarkers =
    "at the identity, far from those around, taken for lost";

// Takes these poses away.
void Forget(const std::vector<int>& markers, std::vector<SlamPose>& live);

}  // namespace depthgrid
