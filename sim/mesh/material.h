// Surface appearance for the colour camera. Depth does not depend on it.
#pragma once

#include <Eigen/Core>
#include <string>

namespace depthgrid {

// Solid textures: patterns are functions of the point in world axes (for a mover, in its own axes),
// so no texture coordinates are needed. sim/colour/colour_shaders.cc draws them.
enum class TextureKind {
  kPlain = 0,
  kWood = 1,       // grain along `grain`
  kChecker = 2,    // cubes of side scale_m
  kStripes = 3,    // across `grain`, one pair of stripes per scale_m
  kFabric = 4,     // woven threads
  kPlaster = 5,    // fine bumps in brightness
  kTiles = 6,      // squares of side scale_m with joints in the second colour
  kPlanks = 7,     // floorboards along `grain`, scale_m wide
  kCarpet = 8,     // speckled pile
  kPaper = 9,      // lines of print on the second colour: posters, screens, book spines
  kPainting = 10,  // soft blobs of colour
  kStone = 11,     // marbled
};

enum class Axis { kX = 0, kY = 1, kZ = 2 };

struct Material {
  std::string name;
  Eigen::Vector3f colour = {0.7F, 0.7F, 0.7F};         // linear RGB, 0..1
  Eigen::Vector3f second_colour = {0.5F, 0.5F, 0.5F};  // of the pattern, linear RGB
  TextureKind texture = TextureKind::kPlain;
  float scale_m = 0.1F;   // period of the pattern
  Axis grain = Axis::kX;  // world axis of wood, stripes and planks
  float gloss = 0.0F;     // strength of the specular highlight, 0..1
  float glow = 0.0F;      // emitted light, in units of the colour: lamps, screens, the sky
};

// Display colour, 0..1, to linear light (IEC 61966-2-1).
Eigen::Vector3f LinearFromSrgb(const Eigen::Vector3f& srgb);
Eigen::Vector3f SrgbFromLinear(const Eigen::Vector3f& linear);

}  // namespace depthgrid
