// Thickness of walls, and how often they are drawn twice.
#pragma once

#include <optional>

#include "eval/metrics/cell_maps.h"
#include "mapper/core/cell_set.h"

namespace depthgrid {

struct WallThickness {
  double mean_m = 0.0;
  double p95_m = 0.0;
};

// Thickness at each wall cell of the scored set: the shortest of the four runs of wall cells
// through it, along the axes and the diagonals. A wall one cell wide is one cell thick at any
// angle. Empty without walls.
std::optional<WallThickness> ThicknessOf(const CellSet& walls, const CellSet& scored);

// Distance within which a second wall is searched: typical of SLAM's drift before a loop is closed.
constexpr double kDoubleWallReachM = 0.3;

// Within how many cells, diagonal steps counting one, a wall lies beside a true one: as in the cell
// scores.
constexpr int kWallToleranceCells = 1;

// Share of the scored estimated wall cells that have, across their wall (along the axis of the
// shorter run) and beyond a gap, a second estimated wall within kDoubleWallReachM, where not each
// of the two lies beside a true wall of its own. The two faces of something solid are two such
// walls. Empty without walls.
std::optional<double> DoubleWallRate(const ScoredCells& walls);

}  // namespace depthgrid
