// Eq. 5-6: poses that agree best with measured relative poses (docs/math.md, "Pose graph").
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// A measured relative pose between two nodes.
struct PoseConstraint {
  int from = 0;  // indices into the poses
  int to = 0;
  Pose2 from_from_to;
  Eigen::Vector3d sigma = Eigen::Vector3d::Ones();  // x m, y m, yaw rad, in axes of `from`
  bool robust = false;                              // Huber instead of squared
};

struct PoseGraphOptions {
  // Residual at which Huber's cost becomes linear, in standard deviations.
  double huber_sigmas = 3.0;
  int max_iterations = 50;

  void Visit(OptionsVisitor& v);
};

struct PoseGraphSolution {
  std::vector<Pose2> poses;
  bool converged = false;
  int iterations = 0;
  double cost = 0.0;
};

// Eq. 6 with the standard relative pose from^-1 * to: measured minus estimated, translation first,
// angle wrapped.
Eigen::Vector3d ConstraintError(const Pose2& from, const Pose2& to, const Pose2& from_from_to);

// Derivatives of ConstraintError by (x, y, yaw) of `from` and of `to`.
struct ConstraintJacobians {
  Eigen::Matrix3d by_from;
  Eigen::Matrix3d by_to;
};
ConstraintJacobians JacobiansOf(const Pose2& from, const Pose2& to);

// The error's chi-square.
double ConstraintChi2(const std::vector<Pose2>& poses, const PoseConstraint& constraint);

// Minimises 1/2 sum rho(e^T Sigma^-1 e) from the given poses; the first one stays where it is.
PoseGraphSolution SolvePoseGraph(const std::vector<Pose2>& poses,
                                 const std::vector<PoseConstraint>& constraints,
                                 const PoseGraphOptions& options);

}  // namespace depthgrid
