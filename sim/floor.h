// Finding the floor of a mesh whose file does not say where it is.
#pragma once

#include <optional>

#include "sim/triangle_mesh.h"

namespace depthgrid {

// The height of the lowest level surface that faces up, lies in the lower half of the mesh and is
// large: at least a quarter of the mesh's footprint (the rectangle around it) and a quarter of the
// largest such surface. Meshes whose floor faces the wrong way are read as if it faced up.
std::optional<double> FindFloor(const TriangleMesh& mesh);

// Whether level surface facing up covers a quarter of the footprint at this height (within 2 cm).
bool HasFloorAt(const TriangleMesh& mesh, double z_m);

}  // namespace depthgrid
