// What a Kalman filter should know of a disturbed SLAM system (docs/math.md, "Fusion").
#pragma once

#include "mapper/fuse/fusion_options.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

// Jitter as it is. All that grows with time becomes a random walk that grows as fast in the long
// run: walk, drift of the rate, bias, jumps. Position is the mean of forward and left.
SlamNoiseOptions NoiseOf(const SlamOptions& slam);

}  // namespace depthgrid
