// The map a perfect mapper would draw (docs/truth.md).
#pragma once

#include <vector>

#include "mapper/core/occupancy_map.h"
#include "mapper/core/trajectory.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

struct TruthGridOptions {
  double resolution_m = 0.05;
  // Heights above the floor at which a surface is an obstacle, both included.
  double band_low_m = 0.1;
  double band_high_m = 1.8;
};

// Occupied: cells that a surface crosses inside the band (surfaces, not interiors). Free: cells
// reachable from the camera's path through unoccupied cells (4-connected). Unknown: the rest. The
// rectangle contains all occupied cells and the path. Throws InputError when it would be too large.
StateMap TruthMap(const TriangleMesh& mesh, double floor_z_m, const Trajectory& world_from_camera,
                  const TruthGridOptions& options);

// The occupied cells alone; everything else is unknown.
StateMap SurfaceCells(const TriangleMesh& mesh, double floor_z_m, const TruthGridOptions& options);

// Marks as free the unknown cells that are reachable from `from` through unoccupied cells
// (4-connected).
void FloodFree(StateMap& map, const std::vector<Cell>& from);

}  // namespace depthgrid
