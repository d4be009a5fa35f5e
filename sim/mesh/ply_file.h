// PLY meshes, ASCII and binary. Not read through assimp, whose reader (5.2) hangs on truncated
// files.
#pragma once

#include <string>

#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// Reads the vertices' x, y, z and the faces, triangulated; ignores all else. Throws InputError
// unless the file is a complete PLY file.
TriangleMesh ReadPly(const std::string& path);

}  // namespace depthgrid
