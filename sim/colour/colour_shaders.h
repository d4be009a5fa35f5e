// The GLSL of the colour camera: lighting and procedural textures.
#pragma once

#include <string>

#include "sim/mesh/material.h"

namespace depthgrid {

// The static scene is stored in world axes, a mover in its own axes with a matrix to the world.
// Each has its own programs, so a scene without movers does not pay for them.
enum class Drawn { kStanding, kMoving };

// Transforms vertices to clip space; shared by all programs.
std::string VertexShader(Drawn drawn);
// Writes linear z only.
std::string DepthFragmentShader();
// Lit and textured. One program per texture, as a software renderer runs every branch for every
// pixel.
std::string ColourFragmentShader(TextureKind texture, Drawn drawn);

}  // namespace depthgrid
