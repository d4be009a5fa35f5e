#include "sim/shapes/material_options.h"

namespace depthgrid {

Eigen::Vector3f LinearFrom255(const std::array<double, 3>& srgb) {
  return LinearFromSrgb(Eigen::Vector3d(srgb[0], srgb[1], srgb[2]).cast<float>() / 255.0F);
}

void MaterialOptions::Visit(OptionsVisitor& v) {
  v.Tuple("colour", colour, {0, 255}, "sRGB, 0 to 255");
  v.Tuple("second_colour", second_colour, {0, 255}, "of the pattern; default: colour, darker");
  v.Choice("texture", texture,
           {{TextureKind::kPlain, "plain"},
            {TextureKind::kWood, "wood"},
            {TextureKind::kChecker, "checker"},
            {TextureKind::kStripes, "stripes"},
            {TextureKind::kFabric, "fabric"},
            {TextureKind::kPlaster, "plaster"},
            {TextureKind::kTiles, "tiles"},
            {TextureKind::kPlanks, "planks"},
            {TextureKind::kCarpet, "carpet"},
            {TextureKind::kPaper, "paper"},
            {TextureKind::kPainting, "painting"},
            {TextureKind::kStone, "stone"}},
           "pattern");
  v.Number("scale_m", scale_m, {1e-4, 100.0}, "period of the pattern");
  v.Choice("grain", grain, {{Axis::kX, "x"}, {Axis::kY, "y"}, {Axis::kZ, "z"}},
           "world axis of wood, planks and stripes");
  v.Number("gloss", gloss, {0.0, 1.0}, "share of a highlight");
  v.Number("glow", glow, {0.0, 100.0}, "light given off, times the colour");
}

Material MaterialOptions::Make(const std::string& name) const {
  constexpr float kDarker = 0.6F;  // second colour when none is given, as a factor of the first
  Material m;
  m.name = name;
  m.colour = LinearFrom255(colour);
  m.second_colour =
      second_colour[0] < 0 ? Eigen::Vector3f(kDarker * m.colour) : LinearFrom255(second_colour);
  m.texture = texture;
  m.scale_m = static_cast<float>(scale_m);
  m.grain = grain;
  m.gloss = static_cast<float>(gloss);
  m.glow = static_cast<float>(glow);
  return m;
}

}  // namespace depthgrid
