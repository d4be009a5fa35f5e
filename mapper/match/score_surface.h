// The covariance of a match from the scores of all poses around it (Olson 2009): slower and coarser
// than the curvature (match_information.h), but includes other maxima.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapper/match/lattice_scorer.h"

namespace depthgrid {

// The score of every candidate of a lattice.
struct ScoreSurface {
  SearchLattice lattice;
  std::vector<std::uint32_t> sums;  // yaw by yaw, row by row, as LatticeScore

  std::size_t Index(const LatticeStep& step) const {
    const auto side = static_cast<std::size_t>(2 * lattice.half_cells + 1);
    const auto yaw = static_cast<std::size_t>(step.yaw_steps + lattice.half_yaw_steps);
    const auto y = static_cast<std::size_t>(step.y_cells + lattice.half_cells);
    const auto x = static_cast<std::size_t>(step.x_cells + lattice.half_cells);
    return (yaw * side + y) * side + x;
  }
};

// Scores all candidates, reusing the surface's memory.
void ScoreAll(const SearchLattice& lattice, const MatchPoints& points, const ProbabilityView& view,
              LatticeScorer& scorer, ScoreSurface& surface);

// Inverse covariance for a small motion (forward m, left m, yaw rad) in base axes of the lattice's
// predicted pose. Candidates weigh exp(sharpness * (sum of probabilities - the best sum)). The
// information of the window itself is subtracted, so a direction in which the score does not fall
// within the window has none; the lattice's rounding variance is added.
Eigen::Matrix3d SurfaceInformation(const ScoreSurface& surface, double sharpness);

}  // namespace depthgrid
