// Finding the floor and the ceiling of a mesh whose file does not say where they are.
#pragma once

#include <optional>

#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// The height of the lowest level surface that faces up, lies in the lower half of the mesh and is
// large: at least a quarter of the mesh's footprint (the rectangle around it) and a quarter of the
// largest such surface. A mesh whose floor is wound the wrong way is treated as if it faced up.
std::optional<double> FindFloor(const TriangleMesh& mesh);

// Whether level surface facing up covers a quarter of the footprint at this height (within 2 cm).
bool HasFloorAt(const TriangleMesh& mesh, double z_m);

// The height of the highest level surface facing down that covers a quarter of the footprint and
// leaves room to stand under it; nothing for open worlds. Where there is one below the next
// storey's floor (as large a level surface facing up, with room to stand under it), it is of this
// storey.
std::optional<double> FindCeiling(const TriangleMesh& mesh, double floor_z_m);

}  // namespace depthgrid
