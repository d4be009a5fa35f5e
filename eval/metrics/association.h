// Which poses of two trajectories belong together: evo's rule (1.9.1,
// `sync.associate_trajectories`).
#pragma once

#include <vector>

#include "mapper/core/trajectory.h"

namespace depthgrid {

// evo's default, also for ICL-NUIM at 30 Hz (half a frame is 0.0167 s).
constexpr double kMaxStampDifferenceS = 0.01;

struct PosePair {
  StampedPose reference;
  StampedPose estimate;
};

// With rotations of unit length: files print nine digits, and what is left out would reach relative
// motions as 1e-8 m.
PosePair PairOf(StampedPose reference, StampedPose estimate);

// For each pose of the shorter trajectory (the estimate, when both are as long) the pose of the
// other with the nearest stamp, the first on ties, if it is within the limit; no interpolation. A
// pose of the longer trajectory may serve twice, as in evo.
std::vector<PosePair> Associate(const Trajectory& reference, const Trajectory& estimate,
                                double max_difference_s = kMaxStampDifferenceS);

}  // namespace depthgrid
