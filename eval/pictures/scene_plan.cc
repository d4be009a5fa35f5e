#include "eval/pictures/scene_plan.h"

#include <algorithm>
#include <cmath>

#include "sim/truth/truth_grid.h"

namespace depthgrid {
namespace {

// Margin as a share of the picture, for the numbers of the grid lines.
constexpr double kMarginShare = 0.06;

TruthGridOptions GridFor(const TriangleMesh& mesh) {
  constexpr double kMostCells = 2000.0;  // per side
  TruthGridOptions grid;
  const double longer_m = BoundsOf(mesh).sizes().head<2>().maxCoeff();
  grid.resolution_m *= std::max(1.0, std::ceil(longer_m / grid.resolution_m / kMostCells));
  return grid;
}

GridGeometry FootprintOf(const TriangleMesh& mesh, double resolution_m) {
  const Eigen::AlignedBox3f bounds = BoundsOf(mesh);
  const auto cell_at = [&](const Eigen::Vector3f& corner) {
    const Eigen::Vector2d at = corner.head<2>().cast<double>();
    return OnlyCell(CellOf(at, resolution_m), resolution_m);
  };
  return Union(cell_at(bounds.min()), cell_at(bounds.max()));
}

}  // namespace

RgbImage PlanOf(const Scene& scene, const std::vector<Path>& paths) {
  const TruthGridOptions grid = GridFor(scene.mesh);
  const StateMap map = SurfaceCells(scene.mesh, scene.floor_z_m, grid);
  GridGeometry shown = FootprintOf(scene.mesh, grid.resolution_m);
  for (const Path& path : paths) shown = WithPath(shown, path.poses, 0);
  const int longer_cells = std::max(shown.width_cells, shown.height_cells);
  shown = Widened(shown, static_cast<int>(std::ceil(kMarginShare * longer_cells)));
  StateMap drawn(shown);
  for (std::size_t i = 0; i < drawn.states.size(); ++i) {
    const bool stands = map.At(shown.CellAt(i)) == CellState::kOccupied;
    drawn.states[i] = stands ? CellState::kOccupied : CellState::kFree;
  }
  return AnnotatedMap(PictureOf(drawn, shown), shown, paths, PathDot::kStart, Lattice::kMetres);
}

}  // namespace depthgrid
