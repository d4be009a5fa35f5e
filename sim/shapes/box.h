// Boxes, sharp or with rounded edges (cushions, mattresses, sofa bodies).
#pragma once

#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// Standing on z = 0, centred on the z axis.
TriangleMesh MakeBox(const Eigen::Vector3d& size_m);

// The same with edges and corners rounded by `radius_m` (below half the smallest side), each
// quarter circle cut into 2 * `segments` facets (segments >= 1).
TriangleMesh MakeRoundedBox(const Eigen::Vector3d& size_m, double radius_m, int segments);

}  // namespace depthgrid
