#include "eval/metrics/wall_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/statistics.h"

namespace depthgrid {
namespace {

struct Direction {
  int x = 0;
  int y = 0;
};

Cell Moved(const Cell& cell, const Direction& d, int steps) {
  return {cell.x + steps * d.x, cell.y + steps * d.y};
}

// Steps from a wall cell to the last of its run.
int RunAhead(const CellSet& walls, const Cell& cell, const Direction& d) {
  int steps = 0;
  while (walls.Has(Moved(cell, d, steps + 1))) ++steps;
  return steps;
}

Direction Back(const Direction& d) { return {-d.x, -d.y}; }

int RunCells(const CellSet& walls, const Cell& cell, const Direction& d) {
  return 1 + RunAhead(walls, cell, d) + RunAhead(walls, cell, Back(d));
}

double ThicknessCells(const CellSet& walls, const Cell& cell) {
  constexpr std::array<Direction, 4> kDirections = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  double thinnest = INFINITY;
  for (const Direction& d : kDirections) {
    thinnest = std::min(thinnest, RunCells(walls, cell, d) * std::hypot(d.x, d.y));
  }
  return thinnest;
}

// Cells from the first to the last wall, both included, among those `from` to `to` steps away.
int ExtentBetween(const CellSet& walls, const Cell& cell, const Direction& d, int from, int to) {
  while (from <= to && !walls.Has(Moved(cell, d, from))) ++from;
  while (from <= to && !walls.Has(Moved(cell, d, to))) --to;
  return to - from + 1;
}

// Whether the estimate has a second wall on this side that the truth does not explain, either by
// two walls or by the two faces of a solid object.
bool IsDoubled(const CellSet& true_walls, const CellSet& walls, const Cell& cell,
               const Direction& d, int reach_cells) {
  const int own_end = RunAhead(walls, cell, d);
  for (int other = own_end + 2; other <= own_end + reach_cells; ++other) {
    if (!walls.Has(Moved(cell, d, other))) continue;
    const int own_start = -RunAhead(walls, cell, Back(d));
    const int other_end = other + RunAhead(walls, Moved(cell, d, other), d);
    const int apart = other - own_end;
    return ExtentBetween(true_walls, cell, d, own_start - 1, other_end + 1) <
           std::max(2, apart - 1);
  }
  return false;
}

template <typename Visitor>
void ForScoredWalls(const CellSet& walls, const CellSet& scored, Visitor visit) {
  for (std::size_t i = 0; i < walls.members.size(); ++i) {
    if ((walls.members[i] & scored.members[i]) != 0) visit(walls.geometry.CellAt(i));
  }
}

}  // namespace

std::optional<WallThickness> ThicknessOf(const CellSet& walls, const CellSet& scored) {
  std::vector<double> thickness_m;
  ForScoredWalls(walls, scored, [&](const Cell& cell) {
    thickness_m.push_back(ThicknessCells(walls, cell) * walls.geometry.resolution_m);
  });
  if (thickness_m.empty()) return std::nullopt;
  constexpr double kP95 = 0.95;
  return WallThickness{Summarise(thickness_m).mean, Percentile(thickness_m, kP95)};
}

std::optional<double> DoubleWallRate(const CellSet& true_walls, const CellSet& walls,
                                     const CellSet& scored) {
  const int reach_cells =
      static_cast<int>(std::lround(kDoubleWallReachM / walls.geometry.resolution_m));
  int counted = 0;
  int doubled = 0;
  ForScoredWalls(walls, scored, [&](const Cell& cell) {
    const bool along_x = RunCells(walls, cell, {1, 0}) <= RunCells(walls, cell, {0, 1});
    const Direction across = along_x ? Direction{1, 0} : Direction{0, 1};
    ++counted;
    doubled += IsDoubled(true_walls, walls, cell, across, reach_cells) ||
                       IsDoubled(true_walls, walls, cell, Back(across), reach_cells)
                   ? 1
                   : 0;
  });
  return Ratio(doubled, counted);
}

}  // namespace depthgrid
