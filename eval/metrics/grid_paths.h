// Shortest paths over a grid's cells.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mapper/core/cell_set.h"

namespace depthgrid {

// Shortest paths from one cell to all others over passable cells, with eight neighbours. A diagonal
// step is sqrt(2) cells long and allowed only where both cells beside it are passable.
class GridPaths {
 public:
  // From an impassable start nothing is reached. The search ends when all cells of `stop_after` are
  // settled; if that is empty, when all reachable cells are.
  GridPaths(const CellSet& passable, const Cell& start, const std::vector<Cell>& stop_after = {});

  std::optional<double> LengthCells(const Cell& goal) const;
  // From start to goal, both included; empty when it is not reached.
  std::vector<Cell> PathTo(const Cell& goal) const;

 private:
  GridGeometry geometry_;
  std::vector<float> length_cells_;   // infinite where not reached
  std::vector<std::int8_t> came_by_;  // step that led here; -1 at the start
};

}  // namespace depthgrid
