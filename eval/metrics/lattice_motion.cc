#include "eval/metrics/lattice_motion.h"

#include <array>
#include <cmath>
#include <utility>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

struct StraightRun {
  int length_cells = 0;
  bool goes_on = false;  // at either end, in a row beside it
};

Cell Plus(const Cell& cell, const Cell& step, int times) {
  return {cell.x + times * step.x, cell.y + times * step.y};
}

// The run through a wall cell, along one of the axes.
StraightRun RunThrough(const CellSet& walls, const Cell& cell, const Cell& along) {
  const Cell across{along.y, along.x};
  StraightRun run{1, false};
  for (const int way : {-1, 1}) {
    Cell end = cell;
    while (walls.Has(Plus(end, along, way))) {
      end = Plus(end, along, way);
      ++run.length_cells;
    }
    for (const int side : {-1, 1}) {
      const Cell next = Plus(Plus(end, along, way), across, side);
      // The second cell distinguishes a step of the wall from a corner.
      if (walls.Has(next) && walls.Has(Plus(next, along, way))) run.goes_on = true;
    }
  }
  return run;
}

}  // namespace

bool LieAlongLattice(const CellSet& walls) {
  // Walls at more than 18 degrees to the grid have shorter steps.
  constexpr int kLeastRunCells = 3;
  constexpr std::array<Cell, 2> kAxes = {{{1, 0}, {0, 1}}};
  int along = 0;
  int all = 0;
  for (std::size_t i = 0; i < walls.members.size(); ++i) {
    if (walls.members[i] == 0) continue;
    ++all;
    for (const Cell& axis : kAxes) {
      const StraightRun run = RunThrough(walls, walls.geometry.CellAt(i), axis);
      if (run.length_cells < kLeastRunCells || run.goes_on) continue;
      ++along;
      break;
    }
  }
  return 2 * along > all;
}

Pose2 OntoLattice(const CellSet& true_walls, const std::vector<Eigen::Vector2d>& centres_m,
                  const Pose2& truth_from_cells) {
  const double resolution_m = true_walls.geometry.resolution_m;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : centres_m) middle += p / static_cast<double>(centres_m.size());
  // Only quarter turns about a corner of cells map centres onto centres.
  const Pose2 turn{0.0, 0.0,
                   WrapAngle(0.5 * kPi * std::round(truth_from_cells.yaw_rad / (0.5 * kPi)))};
  const Eigen::Vector2d shift_cells = (truth_from_cells * middle - turn * middle) / resolution_m;
  Pose2 best;
  // Number of cells on walls; on ties, minus the squared distance from `truth_from_cells`, cells^2.
  std::pair<int, double> best_score{-1, 0.0};
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      const Eigen::Vector2d whole(std::round(shift_cells.x()) + dx,
                                  std::round(shift_cells.y()) + dy);
      const Pose2 motion{whole.x() * resolution_m, whole.y() * resolution_m, turn.yaw_rad};
      int over = 0;
      for (const Eigen::Vector2d& p : centres_m) {
        if (true_walls.Has(CellOf(motion * p, resolution_m))) ++over;
      }
      const std::pair<int, double> score{over, -(whole - shift_cells).squaredNorm()};
      if (score <= best_score) continue;
      best_score = score;
      best = motion;
    }
  }
  return best;
}

}  // namespace depthgrid
