#include "mapper/fuse/fusion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mapper/core/symmetric_eigen.h"

namespace depthgrid {
namespace {

// As the threshold of Debiased() (surfel/debias.h), for the same reason.
constexpr double kFeigned = 3.0;
// Time after which SLAM's error is not taken to grow further: a day.
constexpr double kLongestS = 86400.0;

}  // namespace

Eigen::Matrix3d Squared(const Eigen::Vector3d& sigma) {
  return sigma.cwiseProduct(sigma).asDiagonal();
}

Eigen::Matrix3d SeenInverse(const Eigen::Matrix3d& information) {
  constexpr double kUnseen = 1e-9;  // of the largest eigenvalue
  const Eigen::Vector3d& unit = kMotionUnit;
  const Eigen::Matrix3d scaled = unit.asDiagonal() * information * unit.asDiagonal();
  // Mostly all directions are observed and the plain inverse will do.
  constexpr double kPlain = 1e6;  // condition
  const Eigen::Matrix3d plain = scaled.inverse();
  if (scaled.norm() * plain.norm() < kPlain) return unit.asDiagonal() * plain * unit.asDiagonal();
  const SymmetricEigen axes = EigenOf(scaled);
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (axes.values[i] > kUnseen * axes.values[2]) inverse[i] = 1.0 / axes.values[i];
  }
  const Eigen::Matrix3d vectors = unit.asDiagonal() * axes.vectors;
  return vectors * inverse.asDiagonal() * vectors.transpose();
}

SeenBasisMatrix SeenBasis(const Eigen::Matrix3d& information) {
  constexpr double kUnseen = 1e-6;  // of the largest eigenvalue
  const Eigen::Vector3d& unit = kMotionUnit;
  const auto [values, vectors] = EigenOf(unit.asDiagonal() * information * unit.asDiagonal());
  int unseen = 0;
  while (unseen < 3 && values[unseen] <= std::max(kUnseen * values[2], 0.0)) ++unseen;
  return unit.cwiseInverse().asDiagonal() * vectors.rightCols(3 - unseen);
}

InnovationSize SeenSize(const Eigen::Matrix3d& covariance, const Eigen::Matrix3d& information,
                        const Eigen::Vector3d& innovation) {
  const SeenBasisMatrix seen = SeenBasis(information);
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;
  const Square seen_covariance = seen.transpose() * covariance * seen;
  InnovationSize size;
  size.weight = seen * Eigen::LDLT<Square>(seen_covariance).solve(seen.transpose().eval());
  size.chi2 = innovation.dot(size.weight * innovation);
  size.directions = static_cast<int>(seen.cols());
  return size;
}

Eigen::Matrix3d InformationIn(const Pose2& pose, const MatchResult& match) {
  const Eigen::Matrix3d match_from_pose = AdjointOf(Between(match.map_from_base, pose));
  return match_from_pose.transpose() * match.information * match_from_pose;
}

Eigen::Matrix3d InformationFor(const Prediction& prediction, const MatchResult& match,
                               double tilt_rad) {
  const Eigen::Matrix3d information = InformationIn(prediction.map_from_base, match);
  if (tilt_rad <= 0.0) return information;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(prediction.covariance.topLeftCorner<2, 2>());
  const Eigen::Vector2d known_least = solver.eigenvectors().col(1);
  const Eigen::Vector2d across(-known_least.y(), known_least.x());
  const Eigen::Matrix2d told = information.topLeftCorner<2, 2>();
  const double seen = known_least.dot(told * known_least);
  const double feigned = tilt_rad * tilt_rad * across.dot(told * across);
  const double share = seen > kFeigned * feigned ? 1.0 - kFeigned * feigned / seen : 0.0;
  Eigen::Matrix3d cleared = Eigen::Matrix3d::Identity();
  cleared.topLeftCorner<2, 2>() -= (1.0 - std::sqrt(share)) * known_least * known_least.transpose();
  return cleared * information * cleared;
}

Eigen::Vector3d InnovationOf(const Pose2& predicted_map_from_base, const Pose2& map_from_base) {
  return Between(predicted_map_from_base, map_from_base).vector();
}

Pose2 Moved(const Pose2& predicted_map_from_base, const Pose2& matched_map_from_base,
            const Eigen::Matrix3d& gain) {
  if (gain == Eigen::Matrix3d::Zero()) return predicted_map_from_base;
  if (gain == Eigen::Matrix3d::Identity()) return matched_map_from_base;
  const Eigen::Vector3d step = gain * InnovationOf(predicted_map_from_base, matched_map_from_base);
  return predicted_map_from_base * Pose2::FromVector(step);
}

FusedPose FuseWithGain(const Prediction& prediction, const MatchResult& match,
                       const Eigen::Vector3d& gain) {
  FusedPose fused;
  fused.innovation = InnovationOf(prediction.map_from_base, match.map_from_base);
  fused.gain = gain.asDiagonal();
  fused.map_from_base = Moved(prediction.map_from_base, match.map_from_base, fused.gain);
  // Joseph's form, valid for any gain. Unobserved directions of the match equal the prediction, so
  // the gain has no effect there.
  const Eigen::Matrix3d noise = SeenInverse(match.information);
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - fused.gain * noise * match.information;
  fused.covariance =
      kept * prediction.covariance * kept.transpose() + fused.gain * noise * fused.gain.transpose();
  return fused;
}

FusedPose FuseKalman(const Prediction& prediction, const MatchResult& match) {
  FusedPose fused;
  fused.innovation = InnovationOf(prediction.map_from_base, match.map_from_base);
  const Eigen::Matrix3d product = prediction.covariance * match.information;
  const Eigen::Matrix3d inverse = (Eigen::Matrix3d::Identity() + product).inverse();
  fused.gain = inverse * product;
  fused.map_from_base = Moved(prediction.map_from_base, match.map_from_base, fused.gain);
  const Eigen::Matrix3d covariance = inverse * prediction.covariance;
  fused.covariance = 0.5 * (covariance + covariance.transpose());
  return fused;
}

Eigen::Matrix3d WithAddedCovariance(const Eigen::Matrix3d& information,
                                    const Eigen::Matrix3d& covariance) {
  return (Eigen::Matrix3d::Identity() + information * covariance).inverse() * information;
}

Eigen::Matrix3d InnovationWeight(const Prediction& prediction, const Eigen::Matrix3d& information) {
  return WithAddedCovariance(information, prediction.covariance);
}

double InnovationChi2(const Prediction& prediction, const Eigen::Matrix3d& information,
                      const Eigen::Vector3d& innovation) {
  return innovation.dot(InnovationWeight(prediction, information) * innovation);
}

Eigen::Matrix3d AdjointOf(const Pose2& b_from_a) {
  const double c = std::cos(b_from_a.yaw_rad);
  const double s = std::sin(b_from_a.yaw_rad);
  Eigen::Matrix3d adjoint;
  adjoint << c, -s, b_from_a.y_m,  //
      s, c, -b_from_a.x_m,         //
      0, 0, 1;
  return adjoint;
}

Eigen::Matrix3d Transported(const Eigen::Matrix3d& covariance, const Pose2& motion) {
  const Eigen::Matrix3d adjoint = AdjointOf(Inverse(motion));
  return adjoint * covariance * adjoint.transpose();
}

Eigen::Matrix3d SlamStepCovariance(const SlamNoiseOptions& noise, const Pose2& motion,
                                   double duration_s) {
  const auto square = [](double value) { return value * value; };
  const double time_s = std::clamp(duration_s, 0.0, kLongestS);
  const double position_m2 = square(noise.jitter_m) + square(noise.walk_m_per_sqrt_s) * time_s +
                             square(noise.path_share * motion.translation().norm());
  const double yaw_rad2 = square(noise.jitter_rad) + square(noise.walk_rad_per_sqrt_s) * time_s +
                          square(noise.turn_share * motion.yaw_rad);
  return Eigen::Vector3d(position_m2, position_m2, yaw_rad2).asDiagonal();
}

Eigen::Vector3d OracleGain(const Pose2& true_map_from_base, const Pose2& predicted_map_from_base,
                           const Pose2& matched_map_from_base) {
  const Eigen::Vector3d wanted = InnovationOf(predicted_map_from_base, true_map_from_base);
  const Eigen::Vector3d offered = InnovationOf(predicted_map_from_base, matched_map_from_base);
  Eigen::Vector3d gain;
  for (int axis = 0; axis < 3; ++axis) {
    gain[axis] = offered[axis] == 0.0 ? 0.0 : std::clamp(wanted[axis] / offered[axis], 0.0, 1.0);
  }
  return gain;
}

}  // namespace depthgrid
