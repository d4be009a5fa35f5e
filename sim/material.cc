#include "sim/material.h"

#include <cmath>

namespace depthgrid {

Eigen::Vector3f LinearFromSrgb(const Eigen::Vector3f& srgb) {
  return srgb.unaryExpr(
      [](float s) { return s <= 0.04045F ? s / 12.92F : std::pow((s + 0.055F) / 1.055F, 2.4F); });
}

}  // namespace depthgrid
