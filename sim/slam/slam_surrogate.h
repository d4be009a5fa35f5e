// A simulated RGB-D SLAM system: adds such a system's errors to a true trajectory, in 6 DoF, with
// loop closures that correct it (docs/slam_surrogate.md).
#pragma once

#include <cstdint>

#include "mapper/core/slam_output.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

// One live pose per true pose. The SLAM frame is the true world (z up), as the first pose is exact.
// With all errors 0 the poses equal the true ones bit for bit.
SlamOutput DisturbTrajectory(const Trajectory& truth, const SlamOptions& options,
                             std::uint64_t seed);

}  // namespace depthgrid
