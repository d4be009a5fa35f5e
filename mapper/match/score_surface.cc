#include "mapper/match/score_surface.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mapper/core/symmetric_eigen.h"
#include "mapper/match/match_information.h"

namespace depthgrid {
namespace {

// Calls visit(step) for every candidate in the order of ScoreSurface::sums.
template <typename Visitor>
void ForEachStep(const SearchLattice& lattice, Visitor visit) {
  for (int yaw = -lattice.half_yaw_steps; yaw <= lattice.half_yaw_steps; ++yaw) {
    for (int y = -lattice.half_cells; y <= lattice.half_cells; ++y) {
      for (int x = -lattice.half_cells; x <= lattice.half_cells; ++x) visit(LatticeStep{x, y, yaw});
    }
  }
}

// Score-weighted covariance of the candidates, in steps.
Eigen::Matrix3d WeightedCovariance(const ScoreSurface& surface, double sharpness) {
  const std::uint32_t best = *std::max_element(surface.sums.begin(), surface.sums.end());
  const double per_unit = sharpness / kMatchProbScale;
  constexpr double kNegligible = 30.0;  // exp(-30) is below single precision
  double weight_sum = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  std::size_t i = 0;
  ForEachStep(surface.lattice, [&](const LatticeStep& step) {
    const double fall = per_unit * (best - surface.sums[i++]);
    if (fall > kNegligible) return;
    const double weight = std::exp(-fall);
    const Eigen::Vector3d at(step.x_cells, step.y_cells, step.yaw_steps);
    weight_sum += weight;
    mean += weight * at;
    square += weight * at * at.transpose();
  });
  mean /= weight_sum;
  return square / weight_sum - mean * mean.transpose();
}

}  // namespace

void ScoreAll(const SearchLattice& lattice, const MatchPoints& points, const ProbabilityView& view,
              LatticeScorer& scorer, ScoreSurface& surface) {
  surface.lattice = lattice;
  const auto side = static_cast<std::size_t>(2 * lattice.half_cells + 1);
  surface.sums.resize(side * side * static_cast<std::size_t>(2 * lattice.half_yaw_steps + 1));
  scorer.Prepare(lattice, points, view);
  std::size_t i = 0;
  int scored_yaw = lattice.half_yaw_steps + 1;  // none
  ForEachStep(lattice, [&](const LatticeStep& step) {
    if (step.yaw_steps != scored_yaw) scorer.ScoreRotation(step.yaw_steps, -1);
    scored_yaw = step.yaw_steps;
    surface.sums[i++] = scorer.Score(step.x_cells, step.y_cells);
  });
}

Eigen::Matrix3d SurfaceInformation(const ScoreSurface& surface, double sharpness) {
  const SearchLattice& lattice = surface.lattice;
  // Variance of a uniform distribution over one step; n^2 of it over n steps.
  constexpr double kUnitVariance = 1.0 / 12.0;
  // Least squares after the search halves the lattice's rounding error.
  constexpr double kRefined = 0.25;
  const double side = 2.0 * lattice.half_cells + 1.0;
  const double turns = 2.0 * lattice.half_yaw_steps + 1.0;
  const Eigen::Vector3d window =
      kUnitVariance * Eigen::Vector3d(side * side, side * side, turns * turns);
  const Eigen::Vector3d unit = window.cwiseSqrt();
  const Eigen::Matrix3d rounding =
      (kRefined * kUnitVariance * window.cwiseInverse()).asDiagonal();  // in units of the window
  const Eigen::Matrix3d relative = unit.cwiseInverse().asDiagonal() *
                                   WeightedCovariance(surface, sharpness) *
                                   unit.cwiseInverse().asDiagonal();
  const SymmetricEigen spread = EigenOf(relative + rounding);
  // 1 / c is the information of scores and window together, 1 that of the window alone. A direction
  // is determined if the scores halve the window's standard deviation.
  constexpr double kDeterminedVariance = 0.25;
  Eigen::Vector3d information = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double variance = spread.values[i];
    if (variance < kDeterminedVariance) information(i) = 1.0 / variance - 1.0;
  }
  const Eigen::Vector3d per_unit(1.0 / (unit.x() * lattice.resolution_m),
                                 1.0 / (unit.y() * lattice.resolution_m),
                                 1.0 / (unit.z() * lattice.yaw_step_rad));
  const Eigen::Matrix3d in_map = per_unit.asDiagonal() * spread.vectors * information.asDiagonal() *
                                 spread.vectors.transpose() * per_unit.asDiagonal();
  const Eigen::Matrix3d axes = MapFromBaseAxes(lattice.predicted_map_from_base.yaw_rad);
  return axes.transpose() * in_map * axes;
}

}  // namespace depthgrid
