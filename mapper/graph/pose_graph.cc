#include "mapper/graph/pose_graph.h"

#include <ceres/ceres.h>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

class RelativePoseCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit RelativePoseCost(const PoseConstraint& constraint)
      : measured_(constraint.from_from_to), weight_(constraint.sigma.cwiseInverse()) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Pose2 from{parameters[0][0], parameters[0][1], parameters[0][2]};
    const Pose2 to{parameters[1][0], parameters[1][1], parameters[1][2]};
    Eigen::Map<Eigen::Vector3d> error(residuals);
    error = weight_.cwiseProduct(ConstraintError(from, to, measured_));
    if (jacobians == nullptr) return true;
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const ConstraintJacobians derivative = JacobiansOf(from, to);
    if (jacobians[0] != nullptr) {
      Eigen::Map<RowMajor>{jacobians[0]} = weight_.asDiagonal() * derivative.by_from;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajor>{jacobians[1]} = weight_.asDiagonal() * derivative.by_to;
    }
    return true;
  }

 private:
  Pose2 measured_;
  Eigen::Vector3d weight_;
};

ceres::Solver::Options SolverOptions(const PoseGraphOptions& options) {
  ceres::Solver::Options solver;
  solver.max_num_iterations = options.max_iterations;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;  // independent of any BLAS
  solver.num_threads = 1;
  // Ceres' defaults stop where the cost changes by a millionth: tenths of a millimetre too early.
  solver.function_tolerance = 1e-10;
  solver.parameter_tolerance = 1e-10;
  solver.gradient_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  return solver;
}

}  // namespace

void PoseGraphOptions::Visit(OptionsVisitor& v) {
  v.Number("huber_sigmas", huber_sigmas, {0.1, 1e3},
           "where a loop's cost turns from quadratic to linear, in standard deviations");
  v.Number("max_iterations", max_iterations, {1, 1000}, "iterations of the solver, at most");
}

Eigen::Vector3d ConstraintError(const Pose2& from, const Pose2& to, const Pose2& from_from_to) {
  const Pose2 estimated = Between(from, to);
  return {from_from_to.x_m - estimated.x_m, from_from_to.y_m - estimated.y_m,
          WrapAngle(from_from_to.yaw_rad - estimated.yaw_rad)};
}

ConstraintJacobians JacobiansOf(const Pose2& from, const Pose2& to) {
  const double c = std::cos(from.yaw_rad);
  const double s = std::sin(from.yaw_rad);
  const double dx = to.x_m - from.x_m;
  const double dy = to.y_m - from.y_m;
  ConstraintJacobians jacobians;
  jacobians.by_to << -c, -s, 0,  //
      s, -c, 0,                  //
      0, 0, -1;
  jacobians.by_from = -jacobians.by_to;
  jacobians.by_from.col(2) << s * dx - c * dy, c * dx + s * dy, 1.0;
  return jacobians;
}

double ConstraintChi2(const std::vector<Pose2>& poses, const PoseConstraint& constraint) {
  return ConstraintError(poses[static_cast<std::size_t>(constraint.from)],
                         poses[static_cast<std::size_t>(constraint.to)], constraint.from_from_to)
      .cwiseQuotient(constraint.sigma)
      .squaredNorm();
}

PoseGraphSolution SolvePoseGraph(const std::vector<Pose2>& poses,
                                 const std::vector<PoseConstraint>& constraints,
                                 const PoseGraphOptions& options) {
  PoseGraphSolution solution{.poses = poses, .converged = true};
  if (poses.size() < 2 || constraints.empty()) return solution;
  std::vector<Eigen::Vector3d> values;
  for (const Pose2& pose : poses) values.push_back(pose.vector());
  ceres::Problem problem;
  for (const PoseConstraint& constraint : constraints) {
    const auto from = static_cast<std::size_t>(constraint.from);
    const auto to = static_cast<std::size_t>(constraint.to);
    Require(from < poses.size() && to < poses.size() && from != to,
            "a constraint joins two different poses of the graph");
    problem.AddResidualBlock(
        new RelativePoseCost(constraint),
        constraint.robust ? new ceres::HuberLoss(options.huber_sigmas) : nullptr,
        values[from].data(), values[to].data());
  }
  if (!problem.HasParameterBlock(values[0].data())) {
    problem.AddParameterBlock(values[0].data(), 3);
  }
  problem.SetParameterBlockConstant(values[0].data());
  ceres::Solver::Summary summary;
  ceres::Solve(SolverOptions(options), &problem, &summary);
  solution.converged = summary.termination_type == ceres::CONVERGENCE;
  solution.iterations = static_cast<int>(summary.iterations.size());
  solution.cost = summary.final_cost;
  for (std::size_t i = 0; i < values.size(); ++i) solution.poses[i] = Pose2::FromVector(values[i]);
  solution.poses[0] = poses[0];
  return solution;
}

}  // namespace depthgrid
