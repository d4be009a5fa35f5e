// Walls in scene files.
#pragma once

#include "mapper/io/config.h"
#include "sim/mesh/triangle_mesh.h"
#include "sim/shapes/item_options.h"

namespace depthgrid {

// A shape in its own axes, all triangles of material 0, and the common keys as read.
struct BuiltItem {
  ItemOptions item;
  TriangleMesh mesh;
};

// Reads the wall and removes its openings from `config`. Throws InputError for keys that are wrong
// and openings that do not lie within the wall.
BuiltItem BuildWall(Config& config);

}  // namespace depthgrid
