// PLY meshes, ASCII and binary. Read here and not through assimp, whose reader (5.2) does not come
// back from a file that was cut off.
#pragma once

#include <string>

#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// The vertices' x, y, z and the faces' polygons, cut into triangles; all else is passed over.
// Throws InputError for anything that is not a whole PLY file.
TriangleMesh ReadPly(const std::string& path);

}  // namespace depthgrid
