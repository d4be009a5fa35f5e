// Bicubic least squares (Eq. 4): argmin_T sum_k (1 - M_s(T h_k))^2, to a local minimum near the
// seed (docs/math.md, "Scan matching").
#pragma once

#include "mapper/core/options.h"
#include "mapper/match/fast_match_cost.h"

namespace depthgrid {

enum class SolverMethod { kCeres, kFast };

struct LeastSquaresOptions {
  // Same minimum to 1e-4 m; `ceres` is the paper's solver and the reference.
  SolverMethod method = SolverMethod::kFast;
  int max_iterations = 100;  // Newton needs 3-8, Gauss-Newton (Ceres) 10-70
  // Weights of the prediction's pull as in Cartographer (10 and 40 there, against a scan weight of
  // 1 as here). 0, the default, is prior-free: fusion (Eq. 3) must not count the prediction twice.
  double prior_translation_weight_per_m = 0.0;
  double prior_rotation_weight_per_rad = 0.0;

  void Visit(OptionsVisitor& v);
};

struct LeastSquaresMatch {
  bool converged = false;  // false without points and when the iterations ran out
  Pose2 map_from_base;
  double cost = 0.0;  // F of match_cost.h, prior included, where it was last evaluated
  int iterations = 0;
};

// A local minimum of `cost`, which was prepared near the seed.
LeastSquaresMatch SolveWithNewton(FastMatchCost& cost, const Pose2& seed_map_from_base,
                                  const MatchPrior& prior, int max_iterations);

// The reference: Ceres' BiCubicInterpolator and Levenberg-Marquardt. Points are not empty.
LeastSquaresMatch SolveWithCeres(const MatchPoints& points, const ProbabilityView& view,
                                 const Pose2& seed_map_from_base, const MatchPrior& prior,
                                 int max_iterations);

// One of the two, as the options say. `cost` is prepared for the points and the view near the seed.
LeastSquaresMatch SolveLeastSquares(const LeastSquaresOptions& options, FastMatchCost& cost,
                                    const Pose2& seed_map_from_base,
                                    const Pose2& predicted_map_from_base);

}  // namespace depthgrid
