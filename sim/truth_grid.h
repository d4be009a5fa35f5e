// The map a perfect mapper would draw, and which of its cells the camera had a chance to see
// (docs/truth.md).
#pragma once

#include "mapper/core/camera.h"
#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/core/trajectory.h"
#include "sim/ray_scene.h"
#include "sim/triangle_mesh.h"

namespace depthgrid {

struct TruthGridOptions {
  double resolution_m = 0.05;
  // Heights above the floor at which a surface is an obstacle, both included.
  double band_low_m = 0.1;
  double band_high_m = 1.8;
};

// Occupied: cells a surface crosses inside the band (surfaces, not interiors). Free: what can be
// reached from the camera's path over cells that are not occupied, side by side. Unknown: the rest.
// The rectangle holds all occupied cells and the path. Throws InputError when it would be absurdly
// large.
StateMap TruthMap(const TriangleMesh& mesh, double floor_z_m, const Trajectory& world_from_camera,
                  const TruthGridOptions& options);

// The occupied cells alone; everything else is unknown.
StateMap SurfaceCells(const TriangleMesh& mesh, double floor_z_m, const TruthGridOptions& options);

// Turns the unknown cells that can be reached from `from`, through cells that are not occupied and
// share a side, free.
void FloodFree(StateMap& map, const std::vector<Cell>& from);

struct ObservableOptions {
  double min_range_m = 0.4;  // horizontal distances from the camera, as the mapper's scans
  double max_range_m = 6.0;
  double height_step_m = 0.05;  // between the level rays; thinner boards can slip through
  int threads = 1;
};

// Cells of `truth` that the camera could tell the state of from at least one pose, by level rays at
// heights of the whole band, no more than half a cell apart: the occupied cells where the first of
// a bearing's rays ends (and those that end within half a cell of it), and the free cells before
// it, where the lowest ray is in view (what is below the view cannot be known to be free). Mappers
// have no part in it.
CellSet ObservableCells(const RayScene& scene, double floor_z_m, const StateMap& truth,
                        const PinholeCamera& camera, const Trajectory& world_from_camera,
                        const TruthGridOptions& band, const ObservableOptions& options);

}  // namespace depthgrid
