#include "mapper/fuse/drift_filter.h"

namespace depthgrid {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

}  // namespace

DriftState Predicted(const DriftState& state, const Pose2& motion, int frames,
                     const MotionNoise& noise) {
  const MotionErrors errors = ErrorsOver(frames, noise);
  DriftState next;
  const Pose2 corrected = motion * Pose2::FromVector(errors.bias_added.cwiseProduct(state.bias));
  next.map_from_base = state.map_from_base * corrected;
  next.bias = errors.bias_kept.cwiseProduct(state.bias);
  Matrix6 f = Matrix6::Zero();
  f.topLeftCorner<3, 3>() = AdjointOf(Inverse(corrected));
  f.topRightCorner<3, 3>() = errors.bias_added.asDiagonal();
  f.bottomRightCorner<3, 3>() = errors.bias_kept.asDiagonal();
  next.covariance = f * state.covariance * f.transpose();
  next.with_previous = state.covariance.topRows<3>() * f.topRows<3>().transpose();
  next.covariance.topLeftCorner<3, 3>() += Squared(errors.walk);
  const auto bias_added = errors.bias_added.asDiagonal();
  next.of_motion = bias_added * state.covariance.bottomRightCorner<3, 3>() * bias_added;
  next.of_motion += Squared(errors.walk);
  next.covariance.bottomRightCorner<3, 3>() += Squared(errors.bias_renewed);
  return next;
}

Prediction PredictionOf(const DriftState& predicted, const MotionNoise& noise) {
  return {predicted.map_from_base,
          predicted.covariance.topLeftCorner<3, 3>() + Squared(noise.jitter),
          predicted.of_motion + 2.0 * Squared(noise.jitter)};
}

DriftUpdate Updated(const DriftState& predicted, const MatchResult& match,
                    const MotionNoise& noise) {
  DriftUpdate update;
  update.fused = FuseKalman(PredictionOf(predicted, noise), match);
  // The match measures the camera, from which SLAM's pose differs by its jitter.
  const Eigen::Matrix3d seen = WithAddedCovariance(match.information, Squared(noise.jitter));
  const Eigen::Matrix3d weight =
      WithAddedCovariance(seen, predicted.covariance.topLeftCorner<3, 3>());
  const Eigen::Matrix<double, 6, 3>& gain = update.gain =
      predicted.covariance.leftCols<3>() * weight;
  update.previous_gain = predicted.with_previous * weight;
  const Eigen::Matrix<double, 6, 1> step = gain * update.fused.innovation;
  update.state.map_from_base = predicted.map_from_base * Pose2::FromVector(step.head<3>());
  update.state.bias = predicted.bias + step.tail<3>();
  const Matrix6 covariance = predicted.covariance - gain * predicted.covariance.topRows<3>();
  update.state.covariance = 0.5 * (covariance + covariance.transpose());
  return update;
}

}  // namespace depthgrid
