// A Kalman filter that knows SLAM's motion to have a slowly varying bias and its poses to jitter
// (docs/math.md, "Prior noise").
#pragma once

#include <Eigen/Core>

#include "mapper/fuse/fusion.h"
#include "mapper/fuse/motion_noise.h"

namespace depthgrid {

// Where SLAM's pose, jitter included, lies in the map; and its motion's bias. Covariance of
// (pose, bias), pose in base axes.
struct DriftState {
  Pose2 map_from_base;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

// SLAM moved by `motion`, in so many frames' time.
DriftState Predicted(const DriftState& state, const Pose2& motion, int frames,
                     const MotionNoise& noise);

// The pose of the camera itself: SLAM's without its jitter.
Prediction PredictionOf(const DriftState& predicted, const MotionNoise& noise);

struct DriftUpdate {
  DriftState state;
  FusedPose fused;
  Eigen::Matrix<double, 6, 3> gain;  // of the state
};
DriftUpdate Updated(const DriftState& predicted, const MatchResult& match,
                    const MotionNoise& noise);

}  // namespace depthgrid
