// The candidate poses of the correlative search and their score, defined once for the exhaustive
// reference, the fast search and the loop search, so that all of them can be compared exactly.
#pragma once

#include <cmath>
#include <cstdint>

#include "mapper/core/pose2.h"
#include "mapper/match/match_points.h"
#include "mapper/match/probability_view.h"

namespace depthgrid {

// A cell's probability in steps of 1/1023: 64 cells still sum up in 16 bits, and a step is far
// below what one observation changes.
constexpr int kMatchProbScale = 1023;

inline std::uint16_t QuantisedProb(float prob) {
  // Through int: a vector instruction.
  return static_cast<std::uint16_t>(
      static_cast<int>(prob * static_cast<float>(kMatchProbScale) + 0.5F));
}

// The cells of points at a pose, less `whole_cells`. These expressions are what "the cell of a
// point" means in every search; vectorised versions evaluate them the same way. The position is
// split into whole cells and a remainder so that single precision is enough anywhere in the map.
struct PointCells {
  float cos_cells_per_m = 0.0F;
  float sin_cells_per_m = 0.0F;
  float x_remainder_cells = 0.0F;  // in [0, 1)
  float y_remainder_cells = 0.0F;
  Cell whole_cells;

  PointCells(const Pose2& map_from_base, double resolution_m);

  float X(float x_m, float y_m) const {
    return std::floor((cos_cells_per_m * x_m - sin_cells_per_m * y_m) + x_remainder_cells);
  }
  float Y(float x_m, float y_m) const {
    return std::floor((sin_cells_per_m * x_m + cos_cells_per_m * y_m) + y_remainder_cells);
  }
};

// One candidate, as steps from the predicted pose.
struct LatticeStep {
  int x_cells = 0;
  int y_cells = 0;
  int yaw_steps = 0;
  bool operator==(const LatticeStep&) const = default;
};

// The order in which candidates of equal score win: the smaller rotation first, then the smaller
// translation; what is left is arbitrary but fixed. A search seeded at the truth in featureless
// surroundings therefore stays where it is.
bool PrecedesInLattice(const LatticeStep& a, const LatticeStep& b);

// Rotations are about base's origin, translations along the map's axes by whole cells.
struct SearchLattice {
  Pose2 predicted_map_from_base;
  double resolution_m = 0.05;
  int half_cells = 0;      // translations -half_cells..half_cells in x and y
  int half_yaw_steps = 0;  // rotations -half_yaw_steps..half_yaw_steps
  double yaw_step_rad = 0.0;

  Pose2 PoseOf(const LatticeStep& step) const {
    return {predicted_map_from_base.x_m + step.x_cells * resolution_m,
            predicted_map_from_base.y_m + step.y_cells * resolution_m,
            WrapAngle(predicted_map_from_base.yaw_rad + step.yaw_steps * yaw_step_rad)};
  }
  // Cells at a rotation before translation: translations are whole cells, so they only add to
  // these.
  PointCells CellsAt(int yaw_steps) const {
    return PointCells(PoseOf({0, 0, yaw_steps}), resolution_m);
  }
};

// Covers at least the window. The angular step moves the farthest point by at most one cell
// (Hess et al. 2016, Eq. 7: acos(1 - r^2 / 2 d^2)).
SearchLattice MakeLattice(const Pose2& predicted_map_from_base, double window_m, double window_rad,
                          double resolution_m, double farthest_m);

// The score of one candidate: the sum of the points' quantised probabilities. The plain reference.
std::uint32_t LatticeScore(const SearchLattice& lattice, const LatticeStep& step,
                           const MatchPoints& points, const ProbabilityView& view);

}  // namespace depthgrid
