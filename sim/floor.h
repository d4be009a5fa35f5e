// Finding the floor and the ceiling of a mesh whose file does not say where they are.
#pragma once

#include <optional>

#include "sim/triangle_mesh.h"

namespace depthgrid {

// The height of the lowest level surface that faces up and is large: at least a tenth of the mesh's
// footprint (the rectangle around it) and a quarter of the largest such surface. Meshes whose
// triangles all face the wrong way are read as if they faced up.
std::optional<double> FindFloor(const TriangleMesh& mesh);

// Whether level surface facing up covers a tenth of the footprint at this height (within 2 cm).
bool HasFloorAt(const TriangleMesh& mesh, double z_m);

// The height of the highest level surface facing down that covers a quarter of the footprint and
// leaves room to stand under it; nothing for open worlds.
std::optional<double> FindCeiling(const TriangleMesh& mesh, double floor_z_m);

}  // namespace depthgrid
