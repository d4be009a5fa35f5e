#include "eval/metrics/wall_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
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

// The part of a line across that lies in a wall, in steps from a cell of the line.
struct WallStretch {
  int first = 0;
  int last = 0;
};

WallStretch StretchAt(const CellSet& walls, const Cell& cell, const Direction& d, int step) {
  const Cell at = Moved(cell, d, step);
  return {step - RunAhead(walls, at, Back(d)), step + RunAhead(walls, at, d)};
}

// The true walls beside a stretch, on its own line (0) or on one of those next to it. Empty (first
// > last) without any.
WallStretch TruthBeside(const CellSet& true_walls, const Cell& cell, const Direction& d, int line,
                        WallStretch near) {
  const Cell on_line = {cell.x + line * d.y, cell.y + line * d.x};
  near.first -= kWallToleranceCells;
  near.last += kWallToleranceCells;
  while (near.first <= near.last && !true_walls.Has(Moved(on_line, d, near.first))) ++near.first;
  while (near.first <= near.last && !true_walls.Has(Moved(on_line, d, near.last))) --near.last;
  return near;
}

// Whether each of two walls lies beside a true one of its own. Two true cells that are not farther
// apart across the walls than along them may be of one wall, at up to 45 degrees.
bool AreBothTrue(const CellSet& true_walls, const Cell& cell, const Direction& d,
                 const WallStretch& own, const WallStretch& other) {
  for (int line = -kWallToleranceCells; line <= kWallToleranceCells; ++line) {
    const WallStretch own_truth = TruthBeside(true_walls, cell, d, line, own);
    if (own_truth.first > own_truth.last) continue;
    for (int other_line = -kWallToleranceCells; other_line <= kWallToleranceCells; ++other_line) {
      const WallStretch truth = TruthBeside(true_walls, cell, d, other_line, other);
      if (truth.first > truth.last) continue;
      if (truth.last - own_truth.first > std::abs(other_line - line)) return true;
    }
  }
  return false;
}

// Whether the estimate has a second wall on this side which, with the cell's own, is not explained
// by two true ones.
bool IsDoubled(const CellSet& true_walls, const CellSet& walls, const Cell& cell,
               const Direction& d, int reach_cells) {
  const WallStretch own = StretchAt(walls, cell, d, 0);
  int step = own.last + 2;
  while (step <= own.last + reach_cells) {
    if (!walls.Has(Moved(cell, d, step))) {
      ++step;
      continue;
    }
    const WallStretch other = StretchAt(walls, cell, d, step);
    if (!AreBothTrue(true_walls, cell, d, own, other)) return true;
    step = other.last + 2;
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

std::optional<double> DoubleWallRate(const ScoredCells& walls) {
  const CellSet& drawn = walls.estimate;
  const int reach_cells =
      static_cast<int>(std::lround(kDoubleWallReachM / drawn.geometry.resolution_m));
  int counted = 0;
  int doubled = 0;
  ForScoredWalls(drawn, walls.scored, [&](const Cell& cell) {
    const bool along_x = RunCells(drawn, cell, {1, 0}) <= RunCells(drawn, cell, {0, 1});
    const Direction across = along_x ? Direction{1, 0} : Direction{0, 1};
    ++counted;
    doubled += IsDoubled(walls.truth, drawn, cell, across, reach_cells) ||
                       IsDoubled(walls.truth, drawn, cell, Back(across), reach_cells)
                   ? 1
                   : 0;
  });
  return Ratio(doubled, counted);
}

}  // namespace depthgrid
