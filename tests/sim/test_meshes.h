// Meshes with known answers.
#pragma once

#include <cmath>

#include "mapper/core/angle.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid::test {

inline void AddQuad(TriangleMesh& mesh, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                    const Eigen::Vector3f& c, const Eigen::Vector3f& d) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  mesh.material_of_triangle.resize(mesh.triangles.size(), 0);
}

// Enclosed volume of a closed mesh, positive when its triangles face outward (divergence theorem).
inline double SignedVolume(const TriangleMesh& mesh) {
  double six_volumes = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    six_volumes += mesh.vertices[mesh.triangles[i][0]].cast<double>().dot(ScaledNormal(mesh, i));
  }
  return six_volumes / 6.0;
}

// The parallelogram a, a + u, a + u + v, a + v, cut into n x n squares that share their vertices.
inline TriangleMesh Patch(const Eigen::Vector3f& a, const Eigen::Vector3f& u,
                          const Eigen::Vector3f& v, int n) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const auto part = [n](int k) { return static_cast<float>(k) / static_cast<float>(n); };
      mesh.vertices.push_back(a + part(i) * u + part(j) * v);
    }
  }
  const auto row = static_cast<std::uint32_t>(n + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t k = j * row + i;
      mesh.triangles.push_back({k, k + 1, k + row + 1});
      mesh.triangles.push_back({k, k + row + 1, k + row});
    }
  }
  mesh.material_of_triangle.resize(mesh.triangles.size(), 0);
  return mesh;
}

// The surface of an axis-aligned box, each face cut into n x n squares.
inline TriangleMesh Box(const Eigen::Vector3f& low, const Eigen::Vector3f& high, int n = 1) {
  const Eigen::Vector3f size = high - low;
  const Eigen::Vector3f x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  TriangleMesh mesh = Patch(low, y, x, n);
  Append(mesh, Patch(low + z, x, y, n));
  Append(mesh, Patch(low, x, z, n));
  Append(mesh, Patch(low + y, z, x, n));
  Append(mesh, Patch(low, z, y, n));
  Append(mesh, Patch(low + x, y, z, n));
  return mesh;
}

// A sphere of `rings` x 2 `rings` quads with its vertices on the surface.
inline TriangleMesh Sphere(const Eigen::Vector3f& centre, float radius, int rings) {
  TriangleMesh mesh;
  const int segments = 2 * rings;
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i < segments; ++i) {
      const double polar = kPi * j / rings, turn = 2.0 * kPi * i / segments;
      const Eigen::Vector3d unit(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                                 std::cos(polar));
      mesh.vertices.push_back(centre + radius * unit.cast<float>());
    }
  }
  const auto index = [&](int i, int j) {
    return static_cast<std::uint32_t>(j * segments + i % segments);
  };
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < segments; ++i) {
      mesh.triangles.push_back({index(i, j), index(i, j + 1), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i + 1, j)});
    }
  }
  mesh.material_of_triangle.resize(mesh.triangles.size(), 0);
  return mesh;
}

// A 4.9 x 5.0 x 2.5 m room of about `triangles` triangles: tessellated walls and balls as clutter.
inline TriangleMesh ClutteredRoom(int triangles) {
  constexpr int kBalls = 12;
  const int walls = triangles / 2;
  const int n = std::max(1, static_cast<int>(std::sqrt(walls / 12.0)));
  const int rings =
      std::max(3, static_cast<int>(std::sqrt((triangles - 12 * n * n) / (4.0 * kBalls))));
  TriangleMesh mesh = Box({0, 0, 0}, {4.9F, 5.0F, 2.5F}, n);
  if (triangles <= 12) return mesh;
  for (int k = 0; k < kBalls; ++k) {
    const double turn = 2.0 * kPi * k / kBalls;
    const Eigen::Vector3d centre(2.45 + 1.9 * std::cos(turn), 2.5 + 1.9 * std::sin(turn),
                                 0.3 + 0.15 * (k % 5));
    Append(mesh, Sphere(centre.cast<float>(), 0.3F, rings));
  }
  return mesh;
}

}  // namespace depthgrid::test
