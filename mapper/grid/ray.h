// The cells a line segment crosses, row by row. A point belongs to the half-open cell that contains
// it (mapper/core/grid_geometry.h), so the segment crosses exactly the cells in which it has
// points: at a corner it goes straight to the diagonal neighbour. Cells that it touches in a single
// inner point are left out, which makes both directions give the same cells.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

namespace depthgrid {

// Cells [first_x, last_x] of row y.
struct CellSpan {
  int y = 0;
  int first_x = 0;
  int last_x = 0;
  bool operator==(const CellSpan&) const = default;
};

// The last cell of points with coordinate below x: x itself is outside.
inline int LastCellBelow(double x) { return static_cast<int>(std::ceil(x)) - 1; }
inline int FloorToInt(double x) { return static_cast<int>(std::floor(x)); }

// The part of a segment that goes up in y (from.y() < to.y()) within one row. Where it crosses the
// row's lower or upper boundary, that point is not counted: x is an open end there.
inline CellSpan RowSpan(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double slope,
                        int row, bool starts_here, bool ends_here) {
  const double low_x = starts_here ? from.x() : from.x() + (row - from.y()) * slope;
  const double high_x = ends_here ? to.x() : from.x() + (row + 1 - from.y()) * slope;
  if (low_x <= high_x) {
    const int first = FloorToInt(low_x);
    return {row, first, std::max(first, ends_here ? FloorToInt(high_x) : LastCellBelow(high_x))};
  }
  const int first = FloorToInt(high_x);
  return {row, first, std::max(first, starts_here ? FloorToInt(low_x) : LastCellBelow(low_x))};
}

// Calls visit(CellSpan) for every row the segment crosses, in increasing y. Coordinates are in
// cells (metres / resolution).
template <typename Visit>
void VisitSegmentSpans(Eigen::Vector2d from, Eigen::Vector2d to, Visit&& visit) {
  if (from.y() > to.y()) std::swap(from, to);
  const int first_row = FloorToInt(from.y());
  const int last_row = FloorToInt(to.y());
  const auto visit_one_row = [&](int row) {
    const auto [low, high] = std::minmax(from.x(), to.x());
    visit(CellSpan{row, FloorToInt(low), FloorToInt(high)});
  };
  if (first_row == last_row) return visit_one_row(last_row);
  const double slope = (to.x() - from.x()) / (to.y() - from.y());
  // So nearly along a boundary that a double does not hold the slope: it is taken to lie above.
  if (!std::isfinite(slope)) return visit_one_row(last_row);
  for (int row = first_row; row <= last_row; ++row) {
    visit(RowSpan(from, to, slope, row, row == first_row, row == last_row));
  }
}

}  // namespace depthgrid
