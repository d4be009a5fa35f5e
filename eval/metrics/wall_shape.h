// What walls look like, apart from where they are: how thick, and how often drawn twice.
#pragma once

#include <optional>

#include "mapper/core/cell_set.h"

namespace depthgrid {

struct WallThickness {
  double mean_m = 0.0;
  double p95_m = 0.0;
};

// Of each wall cell in the scored set: the shortest of the four runs of wall through it, along the
// axes and the diagonals. A wall one cell wide is one cell thick at any angle. Empty without walls.
std::optional<WallThickness> ThicknessOf(const CellSet& walls, const CellSet& scored);

// A second wall nearer than this is looked for: drift at which SLAM's walls part before a loop.
constexpr double kDoubleWallReachM = 0.3;

// Share of the scored estimated wall cells that see, across their wall (along the axis of the
// shorter run) and beyond a gap, a second estimated wall within kDoubleWallReachM that the truth
// does not explain: true walls in that stretch, a cell of tolerance on each side, extend over less
// than the distance of the two less a cell, or over a single cell. Empty without walls.
std::optional<double> DoubleWallRate(const CellSet& true_walls, const CellSet& walls,
                                     const CellSet& scored);

}  // namespace depthgrid
