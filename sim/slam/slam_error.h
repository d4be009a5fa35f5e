// The errors of single frames. Each effect has its own random stream, so scaling it or switching it
// off leaves the others' draws unchanged and runs can be compared in pairs.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/trajectory.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

// A small motion in camera axes, its rotation about the point `pivot_m` ahead of the camera.
Pose3 PivotedMotion(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m,
                    double pivot_m);

struct FrameErrors {
  Pose3 motion;  // error of the motion since the frame before: walk, drift, jumps, relocalisation
  Pose3 offset;  // error of this pose only: jitter and bias
  bool lost = false;
  bool relocalised = false;  // the first frame after a burst of lost tracking
};

// One per true pose; the first has no error.
std::vector<FrameErrors> DrawFrameErrors(const Trajectory& truth, const SlamOptions& options,
                                         std::uint64_t seed);

}  // namespace depthgrid
