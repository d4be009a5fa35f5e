// Walls with rectangular openings (doors, windows), closed on all sides.
#pragma once

#include <vector>

#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// A rectangle cut through a wall, in the wall's own axes.
struct WallOpening {
  double along_m = 0.0;   // from the wall's start to the opening's near edge
  double bottom_m = 0.0;  // above the wall's foot; 0 is a doorway
  double width_m = 0.9;
  double height_m = 2.0;
};

// A wall along +x from the origin, standing on z = 0, between the planes y = right_y_m and
// y = right_y_m + thickness_m. Openings lie within it; they may overlap each other.
TriangleMesh MakeWall(double length_m, double height_m, double right_y_m, double thickness_m,
                      const std::vector<WallOpening>& openings);

}  // namespace depthgrid
