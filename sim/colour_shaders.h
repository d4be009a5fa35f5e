// The GLSL of the colour camera: lighting and procedural textures.
#pragma once

#include <string>

#include "sim/material.h"

namespace depthgrid {

// Corners to clip space; shared by all programs.
std::string VertexShader();
// Linear z, nothing else.
std::string DepthFragmentShader();
// Lit and textured. One program a texture: a software renderer runs every branch for every pixel.
std::string ColourFragmentShader(TextureKind texture);

}  // namespace depthgrid
