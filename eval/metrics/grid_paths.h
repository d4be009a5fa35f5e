// Shortest ways over a grid's cells.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mapper/core/cell_set.h"

namespace depthgrid {

// Shortest ways from one cell to all others over passable cells: eight neighbours, a diagonal step
// being sqrt(2) cells long and taken only where both cells beside it are passable.
class GridPaths {
 public:
  // Nothing is reached from a cell that is not passable. `stop_after` ends the search when these
  // cells are all decided; empty for all that can be reached.
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
