// A material as a scene file describes it.
#pragma once

#include <array>
#include <string>

#include "mapper/core/options.h"
#include "sim/mesh/material.h"

namespace depthgrid {

// From sRGB components as scene files give them, 0..255.
Eigen::Vector3f LinearFrom255(const std::array<double, 3>& srgb);

struct MaterialOptions {
  std::array<double, 3> colour = {200, 200, 200};
  std::array<double, 3> second_colour = {-1, -1, -1};
  TextureKind texture = TextureKind::kPlain;
  double scale_m = 0.1;
  Axis grain = Axis::kX;
  double gloss = 0.0;
  double glow = 0.0;

  void Visit(OptionsVisitor& v);
  Material Make(const std::string& name) const;
};

}  // namespace depthgrid
