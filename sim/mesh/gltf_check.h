// Checks the extensions that a glTF file requires: assimp ignores those it does not know, even if
// they change the geometry.
#pragma once

#include <string>

namespace depthgrid {

// Throws InputError naming the first of extensionsRequired that may change the geometry and is not
// known, or when the JSON of a .gltf or .glb file is broken.
void RequireKnownExtensions(const std::string& gltf_path);

}  // namespace depthgrid
