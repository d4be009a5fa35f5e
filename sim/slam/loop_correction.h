// The correction of a SLAM trajectory by a loop closure.
#pragma once

#include <vector>

#include "mapper/core/pose3.h"

namespace depthgrid {

// Moves pose `second` to `target_of_second` with the least change, equally weighted, of the motions
// between `fixed` and `second`: a pose graph of one chain and one loop, solved by Gauss-Newton.
// Poses up to `fixed` stay, poses after `second` move rigidly with it.
std::vector<Pose3> CorrectChain(std::vector<Pose3> poses, int fixed, int second,
                                const Pose3& target_of_second);

}  // namespace depthgrid
