// Pairs the poses of two trajectories by stamp, by evo's rule (1.9.1,
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

// Normalises the rotations: files print nine digits, and the rounding would cause errors of 1e-8 m
// in relative motions.
PosePair PairOf(StampedPose reference, StampedPose estimate);

// Pairs each pose of the shorter trajectory (the estimate, when both have the same length) with the
// pose of the other that has the nearest stamp (the first on ties), if it is within the limit; no
// interpolation. A pose of the longer trajectory may be used twice, as in evo.
std::vector<PosePair> Associate(const Trajectory& reference, const Trajectory& estimate,
                                double max_difference_s = kMaxStampDifferenceS);

}  // namespace depthgrid
