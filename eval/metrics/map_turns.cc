#include "eval/metrics/map_turns.h"

#include <algorithm>
#include <vector>

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/wall_distances.h"
#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

CellSet Mirrored(const CellSet& walls) {
  const GridGeometry& from = walls.geometry;
  GridGeometry geometry = from;
  geometry.min_cell.x = -from.min_cell.x - from.width_cells;
  CellSet mirrored(geometry);
  for (std::size_t i = 0; i < walls.members.size(); ++i) {
    const Cell cell = from.CellAt(i);
    mirrored.members[geometry.Index({-cell.x - 1, cell.y})] = walls.members[i];
  }
  return mirrored;
}

Eigen::Vector2d MiddleOf(const CellSet& walls) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  const std::vector<Eigen::Vector2d> centres = CentresOf(walls);
  for (const Eigen::Vector2d& centre : centres) sum += centre;
  return sum / static_cast<double>(std::max<std::size_t>(1, centres.size()));
}

}  // namespace

std::optional<MapTurn> TurnOf(const StateMap& truth, const PlacedWalls& estimate,
                              const CellSet& scored, double registered_f1_10cm) {
  // Chosen, not measured.
  constexpr double kLiesOver = 0.7;
  constexpr double kTimesBetter = 1.5;
  const CellSet true_walls = CellsIn(truth, CellState::kOccupied);
  const Eigen::Vector2d true_middle = MiddleOf(InBoth(true_walls, scored));
  std::optional<MapTurn> best;
  double best_f1 = std::max(kLiesOver, kTimesBetter * registered_f1_10cm);
  for (int k = 1; k < 8; ++k) {
    const MapTurn turn{k % 4, k >= 4};
    PlacedWalls turned{turn.mirrored ? Mirrored(estimate.walls) : estimate.walls, {}};
    const double yaw_rad = estimate.truth_from_cells.yaw_rad;
    const Pose2 about_zero{
        0.0, 0.0, WrapAngle(0.5 * kPi * turn.quarters + (turn.mirrored ? -yaw_rad : yaw_rad))};
    const Eigen::Vector2d shift = true_middle - about_zero * MiddleOf(turned.walls);
    turned.truth_from_cells = {shift.x(), shift.y(), about_zero.yaw_rad};
    const auto found = RegisterWalls(truth, turned, scored);
    if (!found) continue;
    const auto score =
        ScoreWallDistances({.truth = true_walls, .estimate = turned.walls, .scored = scored},
                           found->truth_from_estimate * turned.truth_from_cells);
    if (score.f1_10cm.value_or(0.0) < best_f1) continue;
    best_f1 = *score.f1_10cm;
    best = turn;
  }
  return best;
}

}  // namespace depthgrid
