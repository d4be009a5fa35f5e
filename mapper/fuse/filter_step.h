// How a filter propagated the errors of its state in a frame.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "mapper/core/pose2.h"

namespace depthgrid {

// The state: SLAM's pose in the map, whose error does not include SLAM's jitter (forward m, left m,
// yaw rad in base axes of `predicted`), and the bias of SLAM's motion (the same per frame). Filters
// without bias and jitter leave them zero. Noises are standard deviations.
struct FilterStep {
  using Gain = Eigen::Matrix<double, 6, 3>;

  Pose2 predicted;                                         // map_from_base
  Eigen::Vector3d walk = Eigen::Vector3d::Zero();          // noise added to the pose
  Eigen::Vector3d bias_added = Eigen::Vector3d::Ones();    // factor of the old bias in the pose
  Eigen::Vector3d bias_kept = Eigen::Vector3d::Zero();     // factor of the old bias in the new
  Eigen::Vector3d bias_renewed = Eigen::Vector3d::Zero();  // noise added to the bias
  // Set if the bias was reset: its standard deviation.
  std::optional<Eigen::Vector3d> new_bias;
  Eigen::Vector3d jitter = Eigen::Vector3d::Zero();  // of SLAM's pose
  // Gains of the reported pose and of the state.
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();
  Gain state_gain = Gain::Zero();
  // The state's pose a frame before, and what this frame's innovation tells of it, in its base axes
  // (docs/math.md, "Groups across a correction").
  Pose2 previous;
  Eigen::Matrix3d previous_gain = Eigen::Matrix3d::Zero();
};

}  // namespace depthgrid
