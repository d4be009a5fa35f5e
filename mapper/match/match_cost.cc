#include "mapper/match/match_cost.h"

#include "mapper/match/bicubic.h"

namespace depthgrid {

MatchCost EvaluateMatchCost(const MatchPoints& points, const ProbabilityView& view,
                            const Pose2& map_from_base) {
  MatchCost cost;
  if (points.size() == 0) return cost;
  const double c = std::cos(map_from_base.yaw_rad);
  const double s = std::sin(map_from_base.yaw_rad);
  for (std::size_t i = 0; i < points.x_m.size(); ++i) {
    // The point relative to base, in map axes.
    const Eigen::Vector2d arm{c * points.x_m[i] - s * points.y_m[i],
                              s * points.x_m[i] + c * points.y_m[i]};
    const BicubicSample m = SampleBicubic(view, map_from_base.translation() + arm);
    const double residual = 1.0 - m.value;
    const Eigen::Vector3d slope{m.dx, m.dy, -arm.y() * m.dx + arm.x() * m.dy};
    Eigen::Matrix3d curvature;  // second derivatives of M(T h)
    const double x_yaw = -arm.y() * m.dxx + arm.x() * m.dxy;
    const double y_yaw = -arm.y() * m.dxy + arm.x() * m.dyy;
    const double yaw_yaw = -arm.y() * x_yaw + arm.x() * y_yaw - arm.x() * m.dx - arm.y() * m.dy;
    curvature << m.dxx, m.dxy, x_yaw, m.dxy, m.dyy, y_yaw, x_yaw, y_yaw, yaw_yaw;
    cost.value += 0.5 * residual * residual;
    cost.gradient -= residual * slope;
    cost.hessian += slope * slope.transpose() - residual * curvature;
  }
  const double weight = 1.0 / points.size();
  cost.value *= weight;
  cost.gradient *= weight;
  cost.hessian *= weight;
  return cost;
}

void MatchPrior::AddTo(const Pose2& estimated_map_from_base, MatchCost& cost) const {
  const Eigen::Vector3d weight{translation_weight_per_m * translation_weight_per_m,
                               translation_weight_per_m * translation_weight_per_m,
                               rotation_weight_per_rad * rotation_weight_per_rad};
  const Eigen::Vector3d offset{estimated_map_from_base.x_m - map_from_base.x_m,
                               estimated_map_from_base.y_m - map_from_base.y_m,
                               WrapAngle(estimated_map_from_base.yaw_rad - map_from_base.yaw_rad)};
  cost.value += 0.5 * offset.dot(weight.cwiseProduct(offset));
  cost.gradient += weight.cwiseProduct(offset);
  cost.hessian.diagonal() += weight;
}

}  // namespace depthgrid
