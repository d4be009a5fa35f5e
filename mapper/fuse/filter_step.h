// What a filter did in a frame to the errors of its state.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "mapper/core/pose2.h"

namespace depthgrid {

// The state: where SLAM's pose lies in the map, but for its jitter (forward m, left m, yaw rad in
// base axes of `predicted`), and the bias of SLAM's motion (the same, a frame). Filters that know
// no bias and no jitter leave them zero. Noises are standard deviations.
struct FilterStep {
  using Gain = Eigen::Matrix<double, 6, 3>;

  Pose2 predicted;                                         // map_from_base
  Eigen::Vector3d walk = Eigen::Vector3d::Zero();          // added to the pose
  Eigen::Vector3d bias_added = Eigen::Vector3d::Ones();    // of the bias before, to the pose
  Eigen::Vector3d bias_kept = Eigen::Vector3d::Zero();     // of the bias before
  Eigen::Vector3d bias_renewed = Eigen::Vector3d::Zero();  // added to it
  // The bias was forgotten, and is known like this.
  std::optional<Eigen::Vector3d> new_bias;
  Eigen::Vector3d jitter = Eigen::Vector3d::Zero();  // of SLAM's pose
  // The shares of the innovation that the reported pose and the state took.
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();
  Gain state_gain = Gain::Zero();
};

}  // namespace depthgrid
