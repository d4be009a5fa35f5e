#include "sim/shapes/superellipsoid.h"

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

double SignedPower(double base, double exponent) {
  return std::copysign(std::pow(std::abs(base), exponent), base);
}

}  // namespace

TriangleMesh MakeSuperellipsoid(const Eigen::Vector3d& size_m, double upright, double level,
                                int segments) {
  Require(size_m.minCoeff() > 0.0 && segments >= 4, "a superellipsoid has a size and facets");
  const int stacks = segments / 2;
  const Eigen::Vector3d half_m = size_m / 2.0;
  TriangleMesh mesh;
  const std::uint32_t bottom = mesh.AddVertex({0, 0, -half_m.z()});
  for (int i = 1; i < stacks; ++i) {
    const double elevation_rad = kPi * (static_cast<double>(i) / stacks - 0.5);
    const double r = SignedPower(std::cos(elevation_rad), upright);
    const double z = SignedPower(std::sin(elevation_rad), upright);
    for (int a = 0; a < segments; ++a) {
      const double azimuth_rad = 2.0 * kPi * a / segments;
      const Eigen::Vector3d unit(r * SignedPower(std::cos(azimuth_rad), level),
                                 r * SignedPower(std::sin(azimuth_rad), level), z);
      mesh.AddVertex(half_m.cwiseProduct(unit));
    }
  }
  const std::uint32_t top = mesh.AddVertex({0, 0, half_m.z()});
  const auto at = [&](int stack, int a) {
    return static_cast<std::uint32_t>(1 + (stack - 1) * segments + a % segments);
  };
  for (int a = 0; a < segments; ++a) {
    mesh.AddTriangle(bottom, at(1, a + 1), at(1, a));
    mesh.AddTriangle(top, at(stacks - 1, a), at(stacks - 1, a + 1));
    for (int i = 1; i + 1 < stacks; ++i) {
      mesh.AddQuad(at(i, a), at(i, a + 1), at(i + 1, a + 1), at(i + 1, a));
    }
  }
  return mesh;
}

}  // namespace depthgrid
