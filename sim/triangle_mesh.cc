#include "sim/triangle_mesh.h"

namespace depthgrid {

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

}  // namespace depthgrid
