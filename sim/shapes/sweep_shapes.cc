#include "sim/shapes/sweep_shapes.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/core/pose3.h"
#include "sim/shapes/corner_cutting.h"

namespace depthgrid {
namespace {

using Eigen::Vector3d;
using Path = std::vector<Vector3d>;

// The path's direction at each point: the mean of the two edges that meet there.
std::vector<Vector3d> Tangents(const Path& path, bool closed) {
  const std::size_t n = path.size();
  std::vector<Vector3d> tangents;
  for (std::size_t i = 0; i < n; ++i) {
    Vector3d sum = Vector3d::Zero();
    if (closed || i > 0) sum += (path[i] - path[(i + n - 1) % n]).normalized();
    if (closed || i + 1 < n) sum += (path[(i + 1) % n] - path[i]).normalized();
    tangents.push_back(sum.normalized());
  }
  return tangents;
}

// A normal to each tangent, carried along the path by parallel transport. On a closed path the
// remaining twist is spread evenly, so that the ends meet.
std::vector<Vector3d> TransportedNormals(const std::vector<Vector3d>& tangents, bool closed) {
  const std::size_t n = tangents.size();
  std::vector<Vector3d> normals = {tangents[0].unitOrthogonal()};
  const auto carried = [](const Vector3d& normal, const Vector3d& from, const Vector3d& to) {
    const Vector3d turned = RotationBetween(from, to) * normal;
    return Vector3d((turned - to * to.dot(turned)).normalized());
  };
  for (std::size_t i = 1; i < n; ++i) {
    normals.push_back(carried(normals[i - 1], tangents[i - 1], tangents[i]));
  }
  if (!closed) return normals;
  const Vector3d back = carried(normals[n - 1], tangents[n - 1], tangents[0]);
  const double twist_rad =
      std::atan2(back.cross(normals[0]).dot(tangents[0]), back.dot(normals[0]));
  for (std::size_t i = 0; i < n; ++i) {
    const double share_rad = twist_rad * static_cast<double>(i) / static_cast<double>(n);
    normals[i] = Eigen::AngleAxisd(share_rad, tangents[i]) * normals[i];
  }
  return normals;
}

// Joins two rings of equal size, the second one ahead along the path.
void JoinRings(TriangleMesh& mesh, std::uint32_t from, std::uint32_t to, int segments) {
  for (int a = 0; a < segments; ++a) {
    const auto i = static_cast<std::uint32_t>(a);
    const auto j = static_cast<std::uint32_t>((a + 1) % segments);
    mesh.AddQuad(from + i, from + j, to + j, to + i);
  }
}

}  // namespace

TriangleMesh MakePrism(const Polygon& outline, double height_m) {
  Require(IsSimple(outline) && height_m > 0.0, "a prism has a simple outline and a height");
  Polygon corners = outline;
  if (SignedArea(corners) < 0.0) std::reverse(corners.begin(), corners.end());
  const auto n = static_cast<std::uint32_t>(corners.size());
  TriangleMesh mesh;
  for (const double z_m : {0.0, height_m}) {
    for (const auto& corner : corners) mesh.AddVertex({corner.x(), corner.y(), z_m});
  }
  for (const auto& t : Triangulate(corners)) {
    mesh.AddTriangle(t[0], t[2], t[1]);
    mesh.AddTriangle(n + t[0], n + t[1], n + t[2]);
  }
  JoinRings(mesh, 0, n, static_cast<int>(n));
  return mesh;
}

TriangleMesh MakeTube(const TubeShape& tube) {
  Require(tube.path.size() >= (tube.closed ? 3U : 2U) && tube.segments >= 3,
          "a tube has a path and facets");
  const Path path = CutCorners(tube.path, tube.smooth, tube.closed);
  const auto tangents = Tangents(path, tube.closed);
  const auto normals = TransportedNormals(tangents, tube.closed);
  const auto n = static_cast<std::uint32_t>(path.size());
  const auto segments = static_cast<std::uint32_t>(tube.segments);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double share = static_cast<double>(i) / (n - 1);
    const double radius_m =
        tube.closed ? tube.start_radius_m
                    : tube.start_radius_m + share * (tube.end_radius_m - tube.start_radius_m);
    const Vector3d other = tangents[i].cross(normals[i]);
    for (std::uint32_t s = 0; s < segments; ++s) {
      const double angle_rad = 2.0 * kPi * s / segments;
      mesh.AddVertex(path[i] +
                     radius_m * (std::cos(angle_rad) * normals[i] + std::sin(angle_rad) * other));
    }
  }
  for (std::uint32_t i = 0; i + (tube.closed ? 0 : 1) < n; ++i) {
    JoinRings(mesh, i * segments, (i + 1) % n * segments, tube.segments);
  }
  if (tube.closed) return mesh;
  const std::uint32_t start = mesh.AddVertex(path.front());
  const std::uint32_t end = mesh.AddVertex(path.back());
  const std::uint32_t last = (n - 1) * segments;
  for (std::uint32_t s = 0; s < segments; ++s) {
    const std::uint32_t next = (s + 1) % segments;
    mesh.AddTriangle(start, next, s);
    mesh.AddTriangle(end, last + s, last + next);
  }
  return mesh;
}

TriangleMesh MakeCurtain(const CurtainShape& curtain) {
  const int columns = curtain.folds * curtain.segments;
  TriangleMesh mesh;
  for (int i = 0; i <= columns; ++i) {
    const double share = static_cast<double>(i) / columns;
    const double phase_rad = 2.0 * kPi * curtain.folds * share;
    const double x_m = (share - 0.5) * curtain.width_m;
    const double y_m = 0.5 * curtain.depth_m * std::sin(phase_rad);
    const double slope =
        kPi * curtain.folds * curtain.depth_m / curtain.width_m * std::cos(phase_rad);
    const Vector3d across = 0.5 * curtain.thickness_m * Vector3d(-slope, 1.0, 0.0).normalized();
    for (const double z_m : {0.0, curtain.height_m}) {
      mesh.AddVertex(Vector3d(x_m, y_m, z_m) - across);
      mesh.AddVertex(Vector3d(x_m, y_m, z_m) + across);
    }
  }
  // Corners of a column: 0 front foot, 1 back foot, 2 front top, 3 back top.
  for (int i = 0; i < columns; ++i) {
    const auto a = static_cast<std::uint32_t>(4 * i);
    const std::uint32_t b = a + 4;
    mesh.AddQuad(a, b, b + 2, a + 2);
    mesh.AddQuad(b + 1, a + 1, a + 3, b + 3);
    mesh.AddQuad(a + 1, b + 1, b, a);
    mesh.AddQuad(a + 2, b + 2, b + 3, a + 3);
  }
  const auto last = static_cast<std::uint32_t>(4 * columns);
  mesh.AddQuad(1, 0, 2, 3);
  mesh.AddQuad(last, last + 1, last + 3, last + 2);
  return mesh;
}

TriangleMesh MakeLeaf(const LeafShape& leaf) {
  TriangleMesh mesh;
  const int rings = leaf.segments - 1;
  Vector3d centre = Vector3d::Zero();
  const double step_m = leaf.length_m / leaf.segments;
  const auto pitch_rad = [&](double share) { return RadFromDeg(leaf.bend_deg) * share; };
  const std::uint32_t base = mesh.AddVertex(centre);
  for (int i = 1; i <= rings; ++i) {
    const double share = static_cast<double>(i) / leaf.segments;
    const double pitch = pitch_rad(share - 0.5 / leaf.segments);
    centre += step_m * Vector3d(std::cos(pitch), 0.0, -std::sin(pitch));
    const Vector3d up(std::sin(pitch), 0.0, std::cos(pitch));
    // Widest a third of the way out, pointed at both ends.
    const double shape = std::sin(kPi * std::pow(share, 0.7));
    const double half_width_m = 0.5 * leaf.width_m * shape;
    const double half_thickness_m = 0.5 * leaf.thickness_m * shape;
    mesh.AddVertex(centre + half_width_m * Vector3d::UnitY());
    mesh.AddVertex(centre + half_thickness_m * up);
    mesh.AddVertex(centre - half_width_m * Vector3d::UnitY());
    mesh.AddVertex(centre - half_thickness_m * up);
  }
  const double tip_pitch = pitch_rad(1.0);
  centre += step_m * Vector3d(std::cos(tip_pitch), 0.0, -std::sin(tip_pitch));
  const std::uint32_t tip = mesh.AddVertex(centre);
  const auto ring = [](int i) { return static_cast<std::uint32_t>(1 + 4 * i); };
  for (std::uint32_t s = 0; s < 4; ++s) {
    const std::uint32_t next = (s + 1) % 4;
    mesh.AddTriangle(base, ring(0) + next, ring(0) + s);
    mesh.AddTriangle(tip, ring(rings - 1) + s, ring(rings - 1) + next);
    for (int i = 0; i + 1 < rings; ++i) {
      mesh.AddQuad(ring(i) + s, ring(i) + next, ring(i + 1) + next, ring(i + 1) + s);
    }
  }
  return mesh;
}

}  // namespace depthgrid
