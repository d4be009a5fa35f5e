// The cost of Eq. 4 with its exact derivatives.
#pragma once

#include <Eigen/Core>

#include "mapper/core/pose2.h"
#include "mapper/match/match_points.h"
#include "mapper/match/probability_view.h"

namespace depthgrid {

// F = 1/(2N) sum_k (1 - M(T h_k))^2 over the N points; derivatives with respect to (x m, y m,
// yaw rad) of T = map_from_base.
struct MatchCost {
  double value = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  // The full second derivative, not J^T J: the residual 1 - M has no gradient where M peaks, so
  // J^T J says nothing about the curvature of a minimum.
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

// The plain reference, in double. Zero for no points.
MatchCost EvaluateMatchCost(const MatchPoints& points, const ProbabilityView& view,
                            const Pose2& map_from_base);

// Pull towards the predicted pose, as in Cartographer's local SLAM:
// F += 1/2 (translation_weight |t - t0|)^2 + 1/2 (rotation_weight wrap(yaw - yaw0))^2.
struct MatchPrior {
  Pose2 map_from_base;
  double translation_weight_per_m = 0.0;
  double rotation_weight_per_rad = 0.0;

  void AddTo(const Pose2& estimated_map_from_base, MatchCost& cost) const;
};

}  // namespace depthgrid
