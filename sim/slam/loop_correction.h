// What a SLAM system does to its trajectory when it closes a loop.
#pragma once

#include <vector>

#include "mapper/core/pose3.h"

namespace depthgrid {

// Moves pose `second` onto `target_of_second` by the least change of the motions between `fixed`
// and `second` (equal weight each; a pose graph of one chain and one loop, solved by Gauss-Newton).
// Poses up to `fixed` stay, poses after `second` move with it as a rigid body.
std::vector<Pose3> CorrectChain(std::vector<Pose3> poses, int fixed, int second,
                                const Pose3& target_of_second);

}  // namespace depthgrid
