// A stand-in for an RGB-D SLAM system: disturbs a true trajectory the way such systems err, in
// 6 DoF, with loop closures that correct it (docs/slam_surrogate.md).
#pragma once

#include <cstdint>

#include "mapper/core/slam_output.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

// One live pose a pose of `truth`. The slam frame is the truth's world: the first pose is exact, z
// is up. Without any error the poses are those of the truth, bit for bit.
SlamOutput DisturbTrajectory(const Trajectory& truth, const SlamOptions& options,
                             std::uint64_t seed);

}  // namespace depthgrid
