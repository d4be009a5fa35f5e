// Triangles in world axes (z up, metres): the only geometry that the cameras and the truth grids
// use. Shapes and mesh files are converted to it.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace depthgrid {

struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;  // metres
  std::vector<std::array<std::uint32_t, 3>>
      triangles;  // indices into vertices, counter-clockwise from outside
  std::vector<std::uint16_t>
      material_of_triangle;  // index into Scene::materials; same length as triangles

  std::uint32_t AddVertex(const Eigen::Vector3d& point) {
    vertices.push_back(point.cast<float>());
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
  // Ignores a triangle that uses a vertex twice.
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  // The quadrilateral a b c d, counter-clockwise from outside, split along a-c.
  void AddQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
};

// Appends `part` to `whole`, with its indices shifted.
void Append(TriangleMesh& whole, const TriangleMesh& part);

// The mesh moved by a rotation, shift and positive scale.
TriangleMesh Transformed(const TriangleMesh& mesh, const Eigen::Affine3d& to_from_mesh);

// Twice the triangle's area times its unit normal.
Eigen::Vector3d ScaledNormal(const TriangleMesh& mesh, std::size_t triangle);

// The bounding box of all vertices; empty when there are none.
Eigen::AlignedBox3f BoundsOf(const TriangleMesh& mesh);

}  // namespace depthgrid
