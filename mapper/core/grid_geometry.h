// The one home of cell arithmetic. Cells have global integer indices: cell (i, j) covers
// [i r, (i+1) r) x [j r, (j+1) r) of the map frame, r the resolution, so every grid's origin is a
// multiple of r and grids of one resolution share their cell boundaries.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

namespace depthgrid {

struct Cell {
  int x = 0;
  int y = 0;
  bool operator==(const Cell&) const = default;
};

inline int CellIndex(double coordinate_m, double resolution_m) {
  return static_cast<int>(std::floor(coordinate_m / resolution_m));
}

inline Cell CellOf(const Eigen::Vector2d& point_m, double resolution_m) {
  return {CellIndex(point_m.x(), resolution_m), CellIndex(point_m.y(), resolution_m)};
}

inline Eigen::Vector2d CellCentre(const Cell& cell, double resolution_m) {
  return {(cell.x + 0.5) * resolution_m, (cell.y + 0.5) * resolution_m};
}

// A rectangle of cells, stored row by row, row 0 the smallest y.
struct GridGeometry {
  double resolution_m = 0.05;
  Cell min_cell;  // lower-left cell
  int width_cells = 0;
  int height_cells = 0;

  bool operator==(const GridGeometry&) const = default;

  std::size_t size() const {
    return static_cast<std::size_t>(width_cells) * static_cast<std::size_t>(height_cells);
  }
  bool Contains(const Cell& cell) const {
    return cell.x >= min_cell.x && cell.y >= min_cell.y && cell.x < min_cell.x + width_cells &&
           cell.y < min_cell.y + height_cells;
  }
  std::size_t Index(const Cell& cell) const {
    return static_cast<std::size_t>(cell.y - min_cell.y) * static_cast<std::size_t>(width_cells) +
           static_cast<std::size_t>(cell.x - min_cell.x);
  }
  Cell CellAt(std::size_t index) const {
    const auto width = static_cast<std::size_t>(width_cells);
    return {min_cell.x + static_cast<int>(index % width),
            min_cell.y + static_cast<int>(index / width)};
  }
  // The lower-left corner of the lower-left cell, as map files want it.
  Eigen::Vector2d OriginM() const { return {min_cell.x * resolution_m, min_cell.y * resolution_m}; }
};

// The rectangle of one cell.
inline GridGeometry OnlyCell(const Cell& cell, double resolution_m) {
  return {resolution_m, cell, 1, 1};
}

// Enlarged by `margin_cells` on every side.
inline GridGeometry Widened(const GridGeometry& geometry, int margin_cells) {
  return {geometry.resolution_m,
          {geometry.min_cell.x - margin_cells, geometry.min_cell.y - margin_cells},
          geometry.width_cells + 2 * margin_cells,
          geometry.height_cells + 2 * margin_cells};
}

// The smallest rectangle that contains both; an empty one (zero size) is ignored. Same resolution
// required. Sides that overflow int are clamped to its maximum, so compare size() with kMaxMapCells
// before allocating.
GridGeometry Union(const GridGeometry& a, const GridGeometry& b);

// The smallest rectangle that contains all cells; empty for none.
GridGeometry BoundsOf(const std::vector<Cell>& cells, double resolution_m);

}  // namespace depthgrid
