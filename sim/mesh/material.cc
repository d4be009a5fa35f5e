#include "sim/mesh/material.h"

#include <cmath>

namespace depthgrid {

Eigen::Vector3f LinearFromSrgb(const Eigen::Vector3f& srgb) {
  return srgb.unaryExpr(
      [](float s) { return s <= 0.04045F ? s / 12.92F : std::pow((s + 0.055F) / 1.055F, 2.4F); });
}

Eigen::Vector3f SrgbFromLinear(const Eigen::Vector3f& linear) {
  return linear.unaryExpr([](float c) {
    return c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F;
  });
}

}  // namespace depthgrid
