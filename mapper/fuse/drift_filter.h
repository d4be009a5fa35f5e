// A Kalman filter that models a slowly varying bias of SLAM's motion and jitter of its poses
// (docs/math.md, "Prior noise").
#pragma once

#include <Eigen/Core>

#include "mapper/fuse/fusion.h"
#include "mapper/fuse/motion_noise.h"

namespace depthgrid {

// SLAM's newest pose, jitter included, placed in the map, and the bias of its motion. Covariance of
// (pose, bias), pose in base axes, without the jitter.
struct DriftState {
  Pose2 map_from_base;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  // Where predicted: covariance of the pose before the motion with this one, each in its base axes.
  Eigen::Matrix3d with_previous = Eigen::Matrix3d::Zero();
  // Covariance of the motion alone.
  Eigen::Matrix3d of_motion = Eigen::Matrix3d::Zero();
};

// The state after SLAM moved by `motion` during `frames` frames.
DriftState Predicted(const DriftState& state, const Pose2& motion, int frames,
                     const MotionNoise& noise);

// The camera's pose: the jitter of SLAM's pose is added to the covariance.
Prediction PredictionOf(const DriftState& predicted, const MotionNoise& noise);

struct DriftUpdate {
  DriftState state;
  FusedPose fused;
  Eigen::Matrix<double, 6, 3> gain;  // gain of the whole state
  // That of the pose before the motion, in its base axes (Rauch, Tung and Striebel 1965).
  Eigen::Matrix3d previous_gain;
};
DriftUpdate Updated(const DriftState& predicted, const MatchResult& match,
                    const MotionNoise& noise);

}  // namespace depthgrid
