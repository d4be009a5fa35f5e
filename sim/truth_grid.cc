#include "sim/truth_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Vertices are single precision: a wall meant at x = 0.7 lies at 0.69999999. What is this close to
// a cell boundary or to a limit of the band is on it. (Half a step of single precision is 2 um at
// 50 m.)
constexpr double kSnap_m = 1e-5;

double SnappedTo(double value, double target, double tolerance) {
  return std::abs(value - target) < tolerance ? target : value;
}

double OnGrid(double cells, double tolerance_cells) {
  return SnappedTo(cells, std::round(cells), tolerance_cells);
}

using Point = std::array<double, 3>;  // x and y in cells, z in metres

// A convex polygon: a triangle cut by two pairs of planes has at most seven corners.
class Polygon {
 public:
  void Add(const Point& p) { points_[static_cast<std::size_t>(size_++)] = p; }
  const Point* begin() const { return points_.data(); }
  const Point* end() const { return points_.data() + size_; }
  bool empty() const { return size_ == 0; }

  // The part with sign * (p[axis] - bound) <= 0 (Sutherland and Hodgman 1974).
  Polygon Cut(std::size_t axis, double bound, double sign) const {
    Polygon kept;
    for (int i = 0; i < size_; ++i) {
      const Point& a = points_[static_cast<std::size_t>(i)];
      const Point& b = points_[static_cast<std::size_t>((i + 1) % size_)];
      const double beyond_a = sign * (a[axis] - bound), beyond_b = sign * (b[axis] - bound);
      if (beyond_a <= 0) kept.Add(a);
      if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0)) {
        const double t = beyond_a / (beyond_a - beyond_b);
        Point crossing;
        for (std::size_t k = 0; k < 3; ++k) crossing[k] = a[k] + t * (b[k] - a[k]);
        constexpr double kRounding_cells = 1e-6;  // of snapped vertices and this interpolation
        crossing[0] = OnGrid(crossing[0], kRounding_cells);
        crossing[1] = OnGrid(crossing[1], kRounding_cells);
        crossing[axis] = bound;
        kept.Add(crossing);
      }
    }
    return kept;
  }

  double Min(std::size_t axis) const {
    double low = (*begin())[axis];
    for (const Point& p : *this) low = std::min(low, p[axis]);
    return low;
  }
  double Max(std::size_t axis) const {
    double high = (*begin())[axis];
    for (const Point& p : *this) high = std::max(high, p[axis]);
    return high;
  }

 private:
  std::array<Point, 8> points_;
  int size_ = 0;
};

// The triangle's part inside the band; empty when it has none.
Polygon InBand(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle,
               double floor_z_m, const TruthGridOptions& options) {
  const double low_m = floor_z_m + options.band_low_m;
  const double high_m = floor_z_m + options.band_high_m;
  Polygon polygon;
  for (const std::uint32_t index : triangle) {
    const Eigen::Vector3d vertex = mesh.vertices[index].cast<double>();
    const double snap_cells = kSnap_m / options.resolution_m;
    polygon.Add({OnGrid(vertex.x() / options.resolution_m, snap_cells),
                 OnGrid(vertex.y() / options.resolution_m, snap_cells),
                 SnappedTo(SnappedTo(vertex.z(), low_m, kSnap_m), high_m, kSnap_m)});
  }
  if (polygon.Max(2) < low_m || polygon.Min(2) > high_m) return {};
  return polygon.Cut(2, low_m, -1.0).Cut(2, high_m, 1.0);
}

int Floor(double cells) { return static_cast<int>(std::floor(cells)); }

// Calls mark(cell) for every cell [i, i+1) x [j, j+1) that holds a point of the closed polygon.
template <typename Mark>
void ForEachCell(const Polygon& polygon, const Mark& mark) {
  const int last_row = Floor(polygon.Max(1));
  for (int row = Floor(polygon.Min(1)); row <= last_row; ++row) {
    const Polygon strip = polygon.Cut(1, row, -1.0).Cut(1, row + 1, 1.0);
    if (strip.empty()) continue;
    // The strip's upper edge belongs to the next row: corners on it are approached, not reached.
    int last_column = Floor(strip.Min(0));
    for (const Point& p : strip) {
      const bool is_reached = p[1] < row + 1;
      last_column =
          std::max(last_column, is_reached ? Floor(p[0]) : static_cast<int>(std::ceil(p[0])) - 1);
    }
    for (int column = Floor(strip.Min(0)); column <= last_column; ++column) mark(Cell{column, row});
  }
}

GridGeometry Bounds(const std::vector<Cell>& cells, double resolution_m) {
  GridGeometry geometry;
  geometry.resolution_m = resolution_m;
  if (cells.empty()) return geometry;
  Cell low = cells.front(), high = cells.front();
  for (const Cell& cell : cells) {
    low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
    high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
  }
  geometry.min_cell = low;
  geometry.width_cells = high.x - low.x + 1;
  geometry.height_cells = high.y - low.y + 1;
  return geometry;
}

// Refuses what is surely a mistake of units before memory is asked for it.
void CheckExtent(const TriangleMesh& mesh, double resolution_m) {
  constexpr double kMaxCells = 2e8;
  if (mesh.vertices.empty()) return;
  Eigen::Vector3f low = mesh.vertices.front(), high = low;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const Eigen::Vector3d cells = (high - low).cast<double>() / resolution_m;
  if (cells.x() * cells.y() > kMaxCells) {
    throw InputError("truth map", "the scene is " + std::to_string(high.x() - low.x()) + " x " +
                                      std::to_string(high.y() - low.y()) + " m, must be below " +
                                      std::to_string(static_cast<long>(kMaxCells)) + " cells of " +
                                      std::to_string(resolution_m) + " m");
  }
}

std::vector<Cell> SurfaceCellList(const TriangleMesh& mesh, double floor_z_m,
                                  const TruthGridOptions& options) {
  Require(options.resolution_m > 0 && options.band_low_m <= options.band_high_m,
          "a resolution above 0 and a band that is not upside down");
  CheckExtent(mesh, options.resolution_m);
  std::vector<Cell> cells;
  for (const auto& triangle : mesh.triangles) {
    const Polygon polygon = InBand(mesh, triangle, floor_z_m, options);
    if (!polygon.empty()) ForEachCell(polygon, [&](const Cell& cell) { cells.push_back(cell); });
  }
  return cells;
}

std::vector<Cell> PathCells(const Trajectory& world_from_camera, double resolution_m) {
  std::vector<Cell> cells;
  for (const StampedPose& pose : world_from_camera) {
    cells.push_back(CellOf(pose.world_from_camera.translation.head<2>(), resolution_m));
  }
  return cells;
}

StateMap Drawn(const GridGeometry& geometry, const std::vector<Cell>& occupied) {
  StateMap map(geometry);
  for (const Cell& cell : occupied) map.states[geometry.Index(cell)] = CellState::kOccupied;
  return map;
}

}  // namespace

StateMap SurfaceCells(const TriangleMesh& mesh, double floor_z_m, const TruthGridOptions& options) {
  const std::vector<Cell> cells = SurfaceCellList(mesh, floor_z_m, options);
  return Drawn(Bounds(cells, options.resolution_m), cells);
}

void FloodFree(StateMap& map, const std::vector<Cell>& from) {
  std::vector<Cell> front;
  const auto reach = [&](const Cell& cell) {
    if (!map.geometry.Contains(cell)) return;
    CellState& state = map.states[map.geometry.Index(cell)];
    if (state != CellState::kUnknown) return;
    state = CellState::kFree;
    front.push_back(cell);
  };
  for (const Cell& cell : from) reach(cell);
  while (!front.empty()) {
    const Cell cell = front.back();
    front.pop_back();
    reach({cell.x - 1, cell.y});
    reach({cell.x + 1, cell.y});
    reach({cell.x, cell.y - 1});
    reach({cell.x, cell.y + 1});
  }
}

StateMap TruthMap(const TriangleMesh& mesh, double floor_z_m, const Trajectory& world_from_camera,
                  const TruthGridOptions& options) {
  const std::vector<Cell> occupied = SurfaceCellList(mesh, floor_z_m, options);
  const std::vector<Cell> path = PathCells(world_from_camera, options.resolution_m);
  StateMap map = Drawn(
      Union(Bounds(occupied, options.resolution_m), Bounds(path, options.resolution_m)), occupied);
  FloodFree(map, path);
  return map;
}

}  // namespace depthgrid
