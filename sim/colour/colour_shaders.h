// The GLSL of the colour camera: lighting and procedural textures.
#pragma once

#include <string>

#include "sim/mesh/material.h"

namespace depthgrid {

// What stands is drawn in world axes, what moves in its own, which a matrix takes there. The
// programs of the two differ, so that movers cost a scene without any nothing.
enum class Drawn { kStanding, kMoving };

// Corners to clip space; shared by all programs.
std::string VertexShader(Drawn drawn);
// Linear z, nothing else.
std::string DepthFragmentShader();
// Lit and textured. One program a texture: a software renderer runs every branch for every pixel.
std::string ColourFragmentShader(TextureKind texture, Drawn drawn);

}  // namespace depthgrid
