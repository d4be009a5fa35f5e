// Checks that an STL file is complete: assimp accepts the remaining facets of a truncated one and
// takes some binary files for text.
#pragma once

#include <string>

namespace depthgrid {

// Throws InputError for a text file without its last `endsolid` and for a binary file whose size
// does not match its number of triangles.
void RequireWholeStl(const std::string& stl_path);

}  // namespace depthgrid
