#include "mapper/core/grid_geometry.h"

#include <algorithm>

#include "mapper/core/error.h"

namespace depthgrid {

GridGeometry Union(const GridGeometry& a, const GridGeometry& b) {
  if (a.size() == 0) return b;
  if (b.size() == 0) return a;
  Require(a.resolution_m == b.resolution_m, "grids to unite have the same resolution");
  GridGeometry both = a;
  both.min_cell = {std::min(a.min_cell.x, b.min_cell.x), std::min(a.min_cell.y, b.min_cell.y)};
  both.width_cells =
      std::max(a.min_cell.x + a.width_cells, b.min_cell.x + b.width_cells) - both.min_cell.x;
  both.height_cells =
      std::max(a.min_cell.y + a.height_cells, b.min_cell.y + b.height_cells) - both.min_cell.y;
  return both;
}

}  // namespace depthgrid
