#include "mapper/match/match_information.h"

#include <Eigen/LU>

#include "mapper/core/symmetric_eigen.h"
#include "mapper/match/bicubic.h"

namespace depthgrid {
namespace {

// Eigenvalues below this share of the largest are rounding errors.
constexpr double kRounding = 1e-9;

// Removes the part of the curvature that `noise` may have caused: along each generalised
// eigenvector, curvature v = lambda noise v, the factor is max(0, 1 - 3 / lambda). At three times
// the noise an estimate is distinguishable from its error.
Eigen::Matrix3d WithoutNoise(const Eigen::Matrix3d& curvature, const Eigen::Matrix3d& noise) {
  constexpr double kNoiseLevels = 3.0;
  const SymmetricEigen pencil = GeneralizedEigenOf(curvature, noise);
  // With V^T noise V = I: curvature = B diag(lambda) B^T, B = noise V.
  const Eigen::Matrix3d back = noise * pencil.vectors;
  const Eigen::Vector3d kept = (pencil.values.array() - kNoiseLevels).max(0.0).matrix();
  return back * kept.asDiagonal() * back.transpose();
}

// Unit eigenvector of a symmetric 2 x 2 matrix for its larger eigenvalue.
Eigen::Vector2d LargestAxis(const Eigen::Matrix2d& matrix) {
  const double difference = matrix(0, 0) - matrix(1, 1);
  const double twice_off = 2.0 * matrix(0, 1);
  const double root = std::sqrt(difference * difference + twice_off * twice_off);
  if (!(root > 0.0)) return Eigen::Vector2d::UnitX();
  // The form without cancellation.
  const Eigen::Vector2d axis = difference >= 0.0 ? Eigen::Vector2d(difference + root, twice_off)
                                                 : Eigen::Vector2d(twice_off, root - difference);
  return axis / axis.norm();
}

// Eigenvectors and eigenvalues (1/m^2) of an information matrix, with a radian of yaw taken as
// `scale_m.z()` metres.
SymmetricEigen AxesOf(const Eigen::Matrix3d& information, const Eigen::Vector3d& scale_m) {
  const Eigen::Vector3d unscale = scale_m.cwiseInverse();
  return EigenOf(unscale.asDiagonal() * information * unscale.asDiagonal());
}

}  // namespace

void MatchInformationOptions::Visit(OptionsVisitor& v) {
  v.Choice("source", source,
           {{InformationSource::kCurvature, "curvature"}, {InformationSource::kSurface, "surface"}},
           "where the covariance of a match comes from");
  v.Number("patch_m", patch_m, {0.0, 10.0}, "length of wall whose beams share their error");
  v.Number("map_sigma_m", map_sigma_m, {0.0, 1.0},
           "standard deviation of where the map has that length of wall");
  v.Number("wall_direction_sigma_rad", wall_direction_sigma_rad, {0.0, 1.0},
           "uncertainty of wall directions; removes what walls seem to tell along themselves");
  v.Number("surface_window_m", surface_window_m, {0.0, 2.0}, "half width of the scored square");
  v.Number("surface_window_deg", surface_window_deg, {0.0, 45.0},
           "half width of the scored angles");
  v.Number("surface_sharpness", surface_sharpness, {1e-3, 1e3},
           "exponent of a pose's weight, per unit of summed probability");
  v.Number("covariance_scale", covariance_scale, {1e-6, 1e6}, "factor on a match's covariance");
}

void AddPatch(const Eigen::Vector3d& gradient, const Eigen::Matrix<double, 3, 2>& shift_curvature,
              double map_sigma_m, Eigen::Matrix3d& gradient_covariance) {
  gradient_covariance += gradient * gradient.transpose();
  // A wall's error matters only across the wall, where its curvature is largest.
  const Eigen::Vector2d across = LargestAxis(shift_curvature.topRows<2>());
  const Eigen::Vector3d shifted = map_sigma_m * (shift_curvature * across);
  gradient_covariance += shifted * shifted.transpose();
}

InformationSums SumUpInformation(const MatchPoints& points, const ProbabilityView& view,
                                 const Pose2& map_from_base,
                                 const MatchInformationOptions& options) {
  InformationSums sums;
  Eigen::Vector3d patch_gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 2> patch_curvature = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Vector2f patch_start = Eigen::Vector2f::Zero();
  const auto end_patch = [&] {
    AddPatch(patch_gradient, patch_curvature, options.map_sigma_m, sums.gradient_covariance);
    patch_gradient.setZero();
    patch_curvature.setZero();
  };
  const double c = std::cos(map_from_base.yaw_rad);
  const double s = std::sin(map_from_base.yaw_rad);
  for (std::size_t i = 0; i < points.x_m.size(); ++i) {
    const Eigen::Vector2f point(points.x_m[i], points.y_m[i]);
    if (i % kPatchStep == 0 && (i == 0 || (point - patch_start).norm() > options.patch_m)) {
      if (i > 0) end_patch();
      patch_start = point;
    }
    const Eigen::Vector2d arm{c * point.x() - s * point.y(), s * point.x() + c * point.y()};
    const BicubicSample m = SampleBicubic(view, map_from_base.translation() + arm);
    const double residual = 1.0 - m.value;
    const Eigen::Vector2d slope{m.dx, m.dy};
    Eigen::Matrix2d wall;
    wall << m.dxx, m.dxy, m.dxy, m.dyy;
    wall = slope * slope.transpose() - residual * wall;
    Eigen::Matrix2d along;
    along << wall(1, 1), -wall(0, 1), -wall(1, 0), wall(0, 0);
    Eigen::Matrix<double, 2, 3> motion;  // derivative of the point by (x, y, yaw)
    motion << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
    sums.curvature += motion.transpose() * wall * motion;
    sums.curvature(2, 2) += residual * arm.dot(slope);
    sums.curvature_along_walls += motion.transpose() * along * motion;
    patch_gradient -= residual * motion.transpose() * slope;
    patch_curvature += motion.transpose() * wall;
    if (m.value > kExplainedProb) ++sums.explained;
  }
  end_patch();
  return sums;
}

Eigen::Matrix3d MapFromBaseAxes(double yaw_rad) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  Eigen::Matrix3d axes;
  axes << c, -s, 0, s, c, 0, 0, 0, 1;
  return axes;
}

Eigen::Matrix3d MatchInformation(const InformationSums& sums, const Pose2& map_from_base,
                                 const MatchInformationOptions& options) {
  const double size = sums.curvature.cwiseAbs().maxCoeff();
  if (sums.explained == 0 || !(size > 0.0)) return Eigen::Matrix3d::Zero();
  const double sigma2 = options.wall_direction_sigma_rad * options.wall_direction_sigma_rad;
  // Away from the minimum a wall's curvature can be negative, but both must be positive definite
  // here.
  const Eigen::Matrix3d noise =
      WithEigenvaluesAtLeast(sigma2 * sums.curvature_along_walls, kRounding * size);
  const Eigen::Matrix3d curvature = WithoutNoise(sums.curvature, noise);
  // Sandwich estimator: an error of the gradient with covariance V moves the minimum by H^-1 times
  // the error, so the inverse covariance is H V^-1 H.
  const double variance = sums.gradient_covariance.trace();
  if (!(variance > 0.0)) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d gradient_covariance =
      WithEigenvaluesAtLeast(sums.gradient_covariance, kRounding * variance);
  const Eigen::Matrix3d in_map =
      curvature * gradient_covariance.inverse() * curvature / options.covariance_scale;
  const Eigen::Matrix3d axes = MapFromBaseAxes(map_from_base.yaw_rad);
  const Eigen::Matrix3d information = axes.transpose() * in_map * axes;
  return 0.5 * (information + information.transpose());
}

Eigen::Matrix3d WithoutWeakDirections(const Eigen::Matrix3d& information, double max_sigma_m,
                                      double arm_m) {
  const Eigen::Vector3d scale{1.0, 1.0, arm_m};
  const auto axes = AxesOf(information, scale);
  const double least = 1.0 / (max_sigma_m * max_sigma_m);
  if (axes.values[0] >= least) return information;
  const Eigen::Vector3d kept = (axes.values.array() < least).select(0.0, axes.values);
  return scale.asDiagonal() * axes.vectors * kept.asDiagonal() * axes.vectors.transpose() *
         scale.asDiagonal();
}

Pose2 WithUndeterminedFrom(const Pose2& predicted_map_from_base, const Pose2& matched_map_from_base,
                           const Eigen::Matrix3d& information, double arm_m) {
  const Eigen::Vector3d scale{1.0, 1.0, arm_m};
  const auto axes = AxesOf(information, scale);
  const Eigen::Vector3d to_predicted =
      scale.cwiseProduct(Between(matched_map_from_base, predicted_map_from_base).vector());
  Eigen::Vector3d undetermined = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (axes.values[i] > kRounding * axes.values[2]) continue;
    const Eigen::Vector3d axis = axes.vectors.col(i);
    undetermined += axis * axis.dot(to_predicted);
  }
  if (undetermined.isZero(0.0)) return matched_map_from_base;
  return matched_map_from_base * Pose2::FromVector(scale.cwiseInverse().cwiseProduct(undetermined));
}

}  // namespace depthgrid
