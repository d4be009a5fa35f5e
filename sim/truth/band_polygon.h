// The part of a triangle inside the obstacle band, seen from above. Internal to sim.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "mapper/core/error.h"
#include "mapper/core/grid_geometry.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// Heights in the world at which a surface is an obstacle, both included.
struct HeightBand {
  double low_z_m = 0.0;
  double high_z_m = 0.0;
};

// Convex: a triangle cut by three pairs of planes has at most nine corners. Corners are (x in
// cells, y in cells, z in metres); the area in x and y may be 0, as for a wall.
class BandPolygon {
 public:
  using Corner = std::array<double, 3>;

  void Add(const Corner& corner) {
    Require(static_cast<std::size_t>(size_) < corners_.size(), "each cut adds one corner at most");
    corners_[static_cast<std::size_t>(size_++)] = corner;
  }
  const Corner* begin() const { return corners_.data(); }
  const Corner* end() const { return corners_.data() + size_; }
  bool empty() const { return size_ == 0; }

  // The part with sign * (corner[axis] - bound) <= 0 (Sutherland and Hodgman 1974).
  BandPolygon Cut(std::size_t axis, double bound, double sign) const;
  double Min(std::size_t axis) const;  // requires a non-empty polygon
  double Max(std::size_t axis) const;

 private:
  std::array<Corner, 9> corners_;
  int size_ = 0;
};

// Vertices are single precision: a wall meant at x = 0.7 lies at 0.69999999. Corners within 10 um
// of a cell boundary or of a limit of the band are put onto it. Empty when nothing is inside the
// band.
BandPolygon InBand(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle,
                   const HeightBand& band, double resolution_m);

// Calls visit(cell, strip) for every cell [i, i+1) x [j, j+1) that holds a point of the closed
// polygon; strip is the polygon's part in that row of cells.
template <typename Visit>
void ForEachCell(const BandPolygon& polygon, const Visit& visit) {
  const auto floor = [](double cells) { return static_cast<int>(std::floor(cells)); };
  const int last_row = floor(polygon.Max(1));
  for (int row = floor(polygon.Min(1)); row <= last_row; ++row) {
    const BandPolygon strip = polygon.Cut(1, row, -1.0).Cut(1, row + 1, 1.0);
    if (strip.empty()) continue;
    // The strip's upper edge belongs to the next row, so corners on it do not count as reached.
    int last_column = floor(strip.Min(0));
    for (const auto& corner : strip) {
      const bool is_reached = corner[1] < row + 1;
      last_column = std::max(
          last_column, is_reached ? floor(corner[0]) : static_cast<int>(std::ceil(corner[0])) - 1);
    }
    for (int column = floor(strip.Min(0)); column <= last_column; ++column) {
      visit(Cell{column, row}, strip);
    }
  }
}

}  // namespace depthgrid
