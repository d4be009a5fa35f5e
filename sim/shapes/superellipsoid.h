// Superellipsoids (Barr 1981): from an ellipsoid to nearly a box.
#pragma once

#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// Centred on the origin. `upright` is the exponent of the outline seen from the side, `level` that
// of the outline from above: 1 is round, towards 0 square. `segments` facets around, half as many
// from pole to pole.
TriangleMesh MakeSuperellipsoid(const Eigen::Vector3d& size_m, double upright, double level,
                                int segments);

}  // namespace depthgrid
