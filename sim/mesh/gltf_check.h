// What a glTF file cannot be read without, held against what assimp reads: it passes over the
// extensions that it does not know, whatever they do to the geometry.
#pragma once

#include <string>

namespace depthgrid {

// Throws InputError naming the first of extensionsRequired that may change the geometry and is not
// known, or when the JSON of a .gltf or .glb file is broken.
void RequireKnownExtensions(const std::string& gltf_path);

}  // namespace depthgrid
