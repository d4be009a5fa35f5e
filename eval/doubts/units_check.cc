#include "eval/doubts/units_check.h"

#include <fmt/format.h>

namespace depthgrid {
namespace {

// Halls and sites are as long, towers are as high, but a room in centimetres is both: 3 x 3 x 2.5
// m.
constexpr float kLargeM = 300.0F;
constexpr float kHighM = 60.0F;

}  // namespace

std::optional<std::string> DoubtOfUnits(const Scene& scene) {
  const Eigen::Vector3f size_m = BoundsOf(scene.mesh).sizes();
  if (size_m.maxCoeff() < kLargeM || size_m.z() < kHighM) return {};
  return fmt::format(
      "scene {}: is {:.0f} x {:.0f} x {:.0f} m large and high: is it in metres? A mesh in "
      "centimetres needs scale: 0.01 where a scene file names it (shape: mesh)",
      scene.name, size_m.x(), size_m.y(), size_m.z());
}

}  // namespace depthgrid
