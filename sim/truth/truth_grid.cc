#include "sim/truth/truth_grid.h"

#include <string>
#include <vector>

#include "mapper/core/error.h"
#include "sim/truth/band_polygon.h"

namespace depthgrid {
namespace {

constexpr double kMaxCells = 2e8;

// Rejects an obvious mistake of units before allocating memory.
void CheckExtent(const TriangleMesh& mesh, double resolution_m) {
  if (mesh.vertices.empty()) return;
  const Eigen::Vector3f size_m = BoundsOf(mesh).sizes();
  const Eigen::Vector3d cells = size_m.cast<double>() / resolution_m;
  if (cells.x() * cells.y() > kMaxCells) {
    throw InputError("truth map", "the scene is " + std::to_string(size_m.x()) + " x " +
                                      std::to_string(size_m.y()) + " m, must be below " +
                                      std::to_string(static_cast<long>(kMaxCells)) + " cells of " +
                                      std::to_string(resolution_m) + " m");
  }
}

std::vector<Cell> SurfaceCellList(const TriangleMesh& mesh, double floor_z_m,
                                  const TruthGridOptions& options) {
  Require(options.resolution_m > 0 && options.band_low_m <= options.band_high_m,
          "a resolution above 0 and a band that is not upside down");
  CheckExtent(mesh, options.resolution_m);
  const HeightBand band = {floor_z_m + options.band_low_m, floor_z_m + options.band_high_m};
  std::vector<Cell> cells;
  for (const auto& triangle : mesh.triangles) {
    const BandPolygon polygon = InBand(mesh, triangle, band, options.resolution_m);
    if (polygon.empty()) continue;
    ForEachCell(polygon, [&](const Cell& cell, const BandPolygon&) { cells.push_back(cell); });
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
  return Drawn(BoundsOf(cells, options.resolution_m), cells);
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
  const GridGeometry geometry =
      Union(BoundsOf(occupied, options.resolution_m), BoundsOf(path, options.resolution_m));
  if (static_cast<double>(geometry.size()) > kMaxCells) {
    throw InputError("truth map",
                     "the scene and the path are " + std::to_string(geometry.width_cells) + " x " +
                         std::to_string(geometry.height_cells) + " cells of " +
                         std::to_string(options.resolution_m) + " m, must be at most " +
                         std::to_string(static_cast<long>(kMaxCells)) + " cells");
  }
  StateMap map = Drawn(geometry, occupied);
  FloodFree(map, path);
  return map;
}

}  // namespace depthgrid
