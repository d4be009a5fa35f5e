// Noise parameters of a simulated SLAM system for the Kalman filter (docs/math.md, "Fusion").
#pragma once

#include "mapper/fuse/fusion_options.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

// Jitter is taken unchanged. All errors that grow with time (walk, drift of the rate, bias, jumps)
// become one random walk with the same long-term growth. Position is the mean of forward and left.
SlamNoiseOptions NoiseOf(const SlamOptions& slam);

}  // namespace depthgrid
