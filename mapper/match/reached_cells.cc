#include "mapper/match/reached_cells.h"

#include <algorithm>
#include <limits>

namespace depthgrid {
namespace {

struct CellRange {
  int low = std::numeric_limits<int>::max();
  int high = std::numeric_limits<int>::min();
};

template <typename CellOfPoint>
CellRange RangeOf(const MatchPoints& points, CellOfPoint cell_of_point) {
  CellRange range;
  const float* x_m = points.x_m.data();
  const float* y_m = points.y_m.data();
  for (int i = 0; i < points.size(); ++i) {
    const int cell = static_cast<int>(cell_of_point(x_m[i], y_m[i]));
    range.low = std::min(range.low, cell);
    range.high = std::max(range.high, cell);
  }
  return range;
}

CellRange Clipped(CellRange needed, int map_first, int map_cells, int border_cells) {
  const int low = map_first - border_cells;
  const int high = map_first + map_cells - 1 + border_cells;
  CellRange clipped{std::clamp(needed.low, low, high), std::clamp(needed.high, low, high)};
  if (clipped.high - clipped.low < border_cells) {
    clipped.low = std::clamp(clipped.low, low, high - border_cells);
    clipped.high = clipped.low + border_cells;
  }
  return clipped;
}

}  // namespace

GridGeometry ReachedCells(const MatchPoints& points, const PointCells& at_pose, int reach_cells,
                          const GridGeometry& map, int border_cells) {
  const CellRange x = RangeOf(points, [=](float x_m, float y_m) { return at_pose.X(x_m, y_m); });
  const CellRange y = RangeOf(points, [=](float x_m, float y_m) { return at_pose.Y(x_m, y_m); });
  const Cell whole = at_pose.whole_cells;
  const CellRange clipped_x =
      Clipped({x.low + whole.x - reach_cells, x.high + whole.x + reach_cells}, map.min_cell.x,
              map.width_cells, border_cells);
  const CellRange clipped_y =
      Clipped({y.low + whole.y - reach_cells, y.high + whole.y + reach_cells}, map.min_cell.y,
              map.height_cells, border_cells);
  GridGeometry reached;
  reached.resolution_m = map.resolution_m;
  reached.min_cell = {clipped_x.low, clipped_y.low};
  reached.width_cells = clipped_x.high - clipped_x.low + 1;
  reached.height_cells = clipped_y.high - clipped_y.low + 1;
  return reached;
}

}  // namespace depthgrid
