#include "mapper/core/grid_geometry.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "mapper/core/error.h"

namespace depthgrid {

namespace {

// Size of the union of two intervals, clamped to the maximum of int.
int Extent(int low_a, int size_a, int low_b, int size_b) {
  const std::int64_t end = std::max(std::int64_t{low_a} + size_a, std::int64_t{low_b} + size_b);
  const std::int64_t most = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(end - std::min(low_a, low_b), most));
}

}  // namespace

GridGeometry Union(const GridGeometry& a, const GridGeometry& b) {
  if (a.size() == 0) return b;
  if (b.size() == 0) return a;
  Require(a.resolution_m == b.resolution_m, "grids to unite have the same resolution");
  GridGeometry both = a;
  both.min_cell = {std::min(a.min_cell.x, b.min_cell.x), std::min(a.min_cell.y, b.min_cell.y)};
  both.width_cells = Extent(a.min_cell.x, a.width_cells, b.min_cell.x, b.width_cells);
  both.height_cells = Extent(a.min_cell.y, a.height_cells, b.min_cell.y, b.height_cells);
  return both;
}

GridGeometry BoundsOf(const std::vector<Cell>& cells, double resolution_m) {
  GridGeometry bounds;
  bounds.resolution_m = resolution_m;
  if (cells.empty()) return bounds;
  Cell low = cells.front(), high = cells.front();
  for (const Cell& cell : cells) {
    low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
    high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
  }
  bounds.min_cell = low;
  bounds.width_cells = high.x - low.x + 1;
  bounds.height_cells = high.y - low.y + 1;
  return bounds;
}

}  // namespace depthgrid
