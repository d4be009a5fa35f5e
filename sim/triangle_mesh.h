// Triangles in world axes (z up, metres): the only geometry the depth camera, the colour camera and
// the truth grids know. Every primitive and every mesh file becomes this.
#pragma once

#include <Eigen/Core>
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
};

// Adds `part` behind `whole`, its vertices shifted to their new indices.
void Append(TriangleMesh& whole, const TriangleMesh& part);

}  // namespace depthgrid
