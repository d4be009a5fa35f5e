#include <ceres/ceres.h>
#include <ceres/cubic_interpolation.h>

#include "mapper/match/least_squares.h"

namespace depthgrid {
namespace {

// Adapter of the view for Ceres' interpolator: row = y, column = x.
class CeresGrid {
 public:
  enum { DATA_DIMENSION = 1 };
  explicit CeresGrid(const ProbabilityView& view) : view_(view) {}
  void GetValue(int row, int column, double* value) const { *value = view_.At({column, row}); }

 private:
  const ProbabilityView& view_;
};

// One residual block for all points, as in Cartographer: (1 - M(T h_k)) / sqrt(N).
class MatchResiduals {
 public:
  MatchResiduals(const MatchPoints& points, const CeresGrid& grid, double resolution_m)
      : points_(points), interpolator_(grid), resolution_m_(resolution_m) {}

  template <typename T>
  bool operator()(const T* pose, T* residuals) const {
    const T c = cos(pose[2]);
    const T s = sin(pose[2]);
    const double weight = 1.0 / std::sqrt(static_cast<double>(points_.size()));
    for (std::size_t i = 0; i < points_.x_m.size(); ++i) {
      const double x_m = points_.x_m[i];
      const double y_m = points_.y_m[i];
      const T column = (pose[0] + c * x_m - s * y_m) / resolution_m_ - 0.5;
      const T row = (pose[1] + s * x_m + c * y_m) / resolution_m_ - 0.5;
      T value;
      interpolator_.Evaluate(row, column, &value);
      residuals[i] = weight * (1.0 - value);
    }
    return true;
  }

 private:
  const MatchPoints& points_;
  ceres::BiCubicInterpolator<CeresGrid> interpolator_;
  double resolution_m_;
};

struct PriorResiduals {
  MatchPrior prior;

  template <typename T>
  bool operator()(const T* pose, T* residuals) const {
    residuals[0] = prior.translation_weight_per_m * (pose[0] - prior.map_from_base.x_m);
    residuals[1] = prior.translation_weight_per_m * (pose[1] - prior.map_from_base.y_m);
    // The seed's yaw is unwrapped to the prior's branch below, so no wrap is needed here.
    residuals[2] = prior.rotation_weight_per_rad * (pose[2] - prior.map_from_base.yaw_rad);
    return true;
  }
};

ceres::Solver::Options SolverOptions(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = max_iterations;
  // Tight, as Gauss-Newton converges slowly here and would otherwise stop millimetres from the
  // minimum.
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

LeastSquaresMatch SolveWithCeres(const MatchPoints& points, const ProbabilityView& view,
                                 const Pose2& seed_map_from_base, const MatchPrior& prior,
                                 int max_iterations) {
  const CeresGrid grid(view);
  double pose[3] = {seed_map_from_base.x_m, seed_map_from_base.y_m,
                    prior.map_from_base.yaw_rad +
                        WrapAngle(seed_map_from_base.yaw_rad - prior.map_from_base.yaw_rad)};
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<MatchResiduals, ceres::DYNAMIC, 3>(
          new MatchResiduals(points, grid, view.geometry.resolution_m), points.size()),
      nullptr, pose);
  if (prior.translation_weight_per_m > 0.0 || prior.rotation_weight_per_rad > 0.0) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PriorResiduals, 3, 3>(new PriorResiduals{prior}), nullptr,
        pose);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(SolverOptions(max_iterations), &problem, &summary);
  LeastSquaresMatch match;
  match.converged = summary.termination_type == ceres::CONVERGENCE;
  match.map_from_base = {pose[0], pose[1], WrapAngle(pose[2])};
  match.cost = summary.final_cost;
  match.iterations = static_cast<int>(summary.iterations.size());
  return match;
}

}  // namespace depthgrid
