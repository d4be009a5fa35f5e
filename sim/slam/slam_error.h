// The errors of single frames, each effect from a stream of its own: scaling or switching off one
// leaves the draws of all others as they are, so that runs can be compared pair by pair.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/trajectory.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

// A small motion in camera axes whose rotation turns about the point `pivot_m` ahead.
Pose3 PivotedMotion(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m,
                    double pivot_m);

struct FrameErrors {
  Pose3 motion;  // error of the motion from the frame before: walk, drift, jumps, relocalisation
  Pose3 offset;  // error of this pose alone: jitter and bias
  bool lost = false;
  bool relocalised = false;  // the first frame after a burst of lost tracking
};

// One a pose of the truth; the first has no error.
std::vector<FrameErrors> DrawFrameErrors(const Trajectory& truth, const SlamOptions& options,
                                         std::uint64_t seed);

}  // namespace depthgrid
