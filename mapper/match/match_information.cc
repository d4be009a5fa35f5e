#include "mapper/match/match_information.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "mapper/match/bicubic.h"

namespace depthgrid {
namespace {

struct InformationSums {
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();         // H, second derivative of the cost
  Eigen::Matrix3d false_curvature = Eigen::Matrix3d::Zero();   // what wrong wall directions give
  Eigen::Matrix3d gradient_scatter = Eigen::Matrix3d::Zero();  // sum g g^T over the points
};

InformationSums SumUp(const MatchPoints& points, const ProbabilityView& view,
                      const Pose2& map_from_base) {
  InformationSums sums;
  const double c = std::cos(map_from_base.yaw_rad);
  const double s = std::sin(map_from_base.yaw_rad);
  Eigen::Matrix2d map_from_base_axes;
  map_from_base_axes << c, -s, s, c;
  for (std::size_t i = 0; i < points.x_m.size(); ++i) {
    const Eigen::Vector2d point{points.x_m[i], points.y_m[i]};
    const BicubicSample m = SampleBicubic(view, map_from_base * point);
    const double residual = 1.0 - m.value;
    const Eigen::Vector2d slope = map_from_base_axes.transpose() * Eigen::Vector2d(m.dx, m.dy);
    Eigen::Matrix2d second;
    second << m.dxx, m.dxy, m.dxy, m.dyy;
    const Eigen::Matrix2d wall = slope * slope.transpose() - residual *
                                                                 map_from_base_axes.transpose() *
                                                                 second * map_from_base_axes;
    // The same curvature turned by 90 degrees: along the wall.
    Eigen::Matrix2d along;
    along << wall(1, 1), -wall(0, 1), -wall(1, 0), wall(0, 0);
    Eigen::Matrix<double, 2, 3> motion;  // of the point per unit of (forward, left, yaw)
    motion << 1.0, 0.0, -point.y(), 0.0, 1.0, point.x();
    const Eigen::Vector3d gradient = -residual * motion.transpose() * slope;
    sums.curvature += motion.transpose() * wall * motion;
    sums.curvature(2, 2) += residual * point.dot(slope);
    sums.false_curvature += motion.transpose() * along * motion;
    sums.gradient_scatter += gradient * gradient.transpose();
  }
  return sums;
}

// Keeps of `signal` in every direction the share by which it exceeds `noise`: with
// signal v = lambda noise v, the factor max(0, 1 - 3 / lambda).
Eigen::Matrix3d Debias(const Eigen::Matrix3d& signal, const Eigen::Matrix3d& noise) {
  constexpr double kNoiseLevels = 3.0;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> pencil(signal, noise);
  // With V^T noise V = I, signal = V^-T diag(lambda) V^-1 and V^-1 = V^T noise.
  const Eigen::Matrix3d back = noise * pencil.eigenvectors();
  const Eigen::Vector3d kept = (pencil.eigenvalues().array() - kNoiseLevels).max(0.0).matrix();
  return back * kept.asDiagonal() * back.transpose();
}

}  // namespace

void MatchInformationOptions::Visit(OptionsVisitor& v) {
  v.Number("wall_direction_sigma_rad", wall_direction_sigma_rad, {0.0, 1.0},
           "uncertainty of wall directions; takes away what they seem to tell along themselves");
  v.Number("covariance_scale", covariance_scale, {1e-6, 1e6},
           "measured over believed covariance of a match");
}

Eigen::Matrix3d MatchInformation(const MatchPoints& points, const ProbabilityView& view,
                                 const Pose2& map_from_base,
                                 const MatchInformationOptions& options) {
  const InformationSums sums = SumUp(points, view, map_from_base);
  const double size = sums.curvature.cwiseAbs().maxCoeff();
  if (!(size > 0.0) || !std::isfinite(size)) return Eigen::Matrix3d::Zero();
  // Away from a minimum walls can count negatively; noise must still be positive definite.
  const double sigma2 = options.wall_direction_sigma_rad * options.wall_direction_sigma_rad;
  constexpr double kFloor = 1e-6;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> false_axes(sigma2 * sums.false_curvature);
  const Eigen::Matrix3d noise = false_axes.eigenvectors() *
                                false_axes.eigenvalues().cwiseMax(kFloor * size).asDiagonal() *
                                false_axes.eigenvectors().transpose();
  const Eigen::Matrix3d curvature = Debias(sums.curvature, noise);
  // Quasi-likelihood dispersion: how much the gradient scatters per unit of curvature.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(curvature);
  double dispersion = 0.0;
  int determined = 0;
  for (int i = 0; i < 3; ++i) {
    const double value = axes.eigenvalues()(i);
    if (value < kFloor * size) continue;
    const Eigen::Vector3d axis = axes.eigenvectors().col(i);
    dispersion += axis.dot(sums.gradient_scatter * axis) / value;
    ++determined;
  }
  if (determined == 0 || !(dispersion > 0.0)) return Eigen::Matrix3d::Zero();
  return curvature * (determined / (dispersion * options.covariance_scale));
}

}  // namespace depthgrid
