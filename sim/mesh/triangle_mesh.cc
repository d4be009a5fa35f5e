#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

void TriangleMesh::AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a == b || b == c || c == a) return;
  triangles.push_back({a, b, c});
  material_of_triangle.push_back(0);
}

void TriangleMesh::AddQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  AddTriangle(a, b, c);
  AddTriangle(a, c, d);
}

void Append(TriangleMesh& whole, const TriangleMesh& part) {
  const auto offset = static_cast<std::uint32_t>(whole.vertices.size());
  whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& t : part.triangles) {
    whole.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  whole.material_of_triangle.insert(whole.material_of_triangle.end(),
                                    part.material_of_triangle.begin(),
                                    part.material_of_triangle.end());
}

TriangleMesh Transformed(const TriangleMesh& mesh, const Eigen::Affine3d& to_from_mesh) {
  TriangleMesh moved = mesh;
  for (auto& vertex : moved.vertices) {
    const Eigen::Vector3d point = to_from_mesh * vertex.cast<double>();
    vertex = point.cast<float>();
  }
  return moved;
}

Eigen::Vector3d ScaledNormal(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
  const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
  const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
  return (b - a).cross(c - a);
}

Eigen::AlignedBox3f BoundsOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f bounds;
  for (const auto& vertex : mesh.vertices) bounds.extend(vertex);
  return bounds;
}

}  // namespace depthgrid
