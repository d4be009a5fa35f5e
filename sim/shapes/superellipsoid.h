// Barr's superellipsoids (1981): from an ellipsoid over a pillow to nearly a box.
#pragma once

#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// Centred on the origin. An exponent of 1 is round, towards 0 is square: `upright` shapes the
// outline seen from the side, `level` the one seen from above. `segments` facets around, half as
// many from pole to pole.
TriangleMesh MakeSuperellipsoid(const Eigen::Vector3d& size_m, double upright, double level,
                                int segments);

}  // namespace depthgrid
