// Whether an STL file is whole: assimp takes the facets that are left of one that was cut off, and
// some of the binary ones for text.
#pragma once

#include <string>

namespace depthgrid {

// Throws InputError for text without its last `endsolid`, and for a binary file of another size
// than its number of triangles gives.
void RequireWholeStl(const std::string& stl_path);

}  // namespace depthgrid
