#include "sim/shapes/revolve.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "sim/mesh/polygon.h"

namespace depthgrid {
namespace {

// The vertices of an outline point: a ring, or a single vertex on the axis.
struct Ring {
  std::uint32_t first = 0;
  bool on_axis = false;
  std::uint32_t At(int segment) const {
    return on_axis ? first : first + static_cast<std::uint32_t>(segment);
  }
};

Ring AddRing(TriangleMesh& mesh, const Eigen::Vector2d& point, int segments) {
  const double r_m = point.x();
  Ring ring{static_cast<std::uint32_t>(mesh.vertices.size()), r_m == 0.0};
  for (int i = 0; i < (ring.on_axis ? 1 : segments); ++i) {
    const double azimuth_rad = 2.0 * kPi * i / segments;
    mesh.AddVertex({r_m * std::cos(azimuth_rad), r_m * std::sin(azimuth_rad), point.y()});
  }
  return ring;
}

}  // namespace

TriangleMesh Revolve(const LatheOutline& outline, int segments) {
  Require(segments >= 3 && outline.size() >= 3, "a lathe outline has an area to turn");
  LatheOutline counter_clockwise = outline;
  if (SignedArea(outline) < 0.0) std::reverse(counter_clockwise.begin(), counter_clockwise.end());

  TriangleMesh mesh;
  std::vector<Ring> rings;
  for (const auto& point : counter_clockwise) rings.push_back(AddRing(mesh, point, segments));
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const Ring& from = rings[i];
    const Ring& to = rings[(i + 1) % rings.size()];
    if (from.on_axis && to.on_axis) continue;
    for (int a = 0; a < segments; ++a) {
      const int b = (a + 1) % segments;
      mesh.AddQuad(from.At(a), from.At(b), to.At(b), to.At(a));
    }
  }
  return mesh;
}

LatheOutline FrustumOutline(double bottom_radius_m, double top_radius_m, double height_m) {
  LatheOutline outline = {{0.0, 0.0}};
  if (bottom_radius_m > 0.0) outline.emplace_back(bottom_radius_m, 0.0);
  if (top_radius_m > 0.0) outline.emplace_back(top_radius_m, height_m);
  outline.emplace_back(0.0, height_m);
  return outline;
}

LatheOutline SphereOutline(double radius_m, int segments) {
  const int stacks = std::max(2, segments / 2);
  LatheOutline outline = {{0.0, -radius_m}};
  for (int i = 1; i < stacks; ++i) {
    const double angle_rad = kPi * i / stacks;
    outline.emplace_back(radius_m * std::sin(angle_rad), -radius_m * std::cos(angle_rad));
  }
  outline.emplace_back(0.0, radius_m);
  return outline;
}

LatheOutline TorusOutline(double ring_radius_m, double tube_radius_m, int segments) {
  LatheOutline outline;
  for (int i = 0; i < segments; ++i) {
    const double angle_rad = 2.0 * kPi * i / segments;
    outline.emplace_back(ring_radius_m + tube_radius_m * std::cos(angle_rad),
                         tube_radius_m * std::sin(angle_rad));
  }
  return outline;
}

}  // namespace depthgrid
