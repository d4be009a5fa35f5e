#include "sim/colour/shading_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// The triangles around each vertex: those of vertex v are triangles[first[v]] .. first[v + 1].
struct Fans {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> triangles;
};

Fans FansOf(const TriangleMesh& mesh) {
  Fans fans;
  fans.first.assign(mesh.vertices.size() + 1, 0);
  for (const auto& t : mesh.triangles) {
    for (const auto vertex : t) ++fans.first[vertex + 1];
  }
  std::partial_sum(fans.first.begin(), fans.first.end(), fans.first.begin());
  fans.triangles.resize(3 * mesh.triangles.size());
  std::vector<std::uint32_t> next(fans.first.begin(), fans.first.end() - 1);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const auto vertex : mesh.triangles[i]) fans.triangles[next[vertex]++] = i;
  }
  return fans;
}

// Mean normal, weighted by area, of the triangles around `vertex` that continue `triangle`.
Eigen::Vector3f CornerNormal(const Fans& fans, const std::vector<Eigen::Vector3d>& scaled_normals,
                             std::uint32_t vertex, std::uint32_t triangle, double least_cosine) {
  const Eigen::Vector3d own = scaled_normals[triangle].normalized();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::uint32_t i = fans.first[vertex]; i < fans.first[vertex + 1]; ++i) {
    const Eigen::Vector3d& other = scaled_normals[fans.triangles[i]];
    if (own.dot(other) >= least_cosine * other.norm()) sum += other;
  }
  return sum.normalized().cast<float>();
}

}  // namespace

ShadingMesh MakeShadingMesh(const TriangleMesh& mesh, const std::vector<Material>& materials) {
  const auto texture_of = [&](std::uint32_t triangle) {
    return materials[mesh.material_of_triangle[triangle]].texture;
  };
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return texture_of(a) < texture_of(b); });
  std::vector<Eigen::Vector3d> scaled_normals;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    scaled_normals.push_back(ScaledNormal(mesh, i));
  }
  const Fans fans = FansOf(mesh);
  const double least_cosine = std::cos(RadFromDeg(kCreaseDeg));

  ShadingMesh shading;
  shading.corners.reserve(3 * order.size());
  for (const std::uint32_t triangle : order) {
    if (shading.batches.empty() || shading.batches.back().texture != texture_of(triangle)) {
      shading.batches.push_back(
          {texture_of(triangle), static_cast<int>(shading.corners.size()), 0});
    }
    for (const auto vertex : mesh.triangles[triangle]) {
      shading.corners.push_back({mesh.vertices[vertex],
                                 CornerNormal(fans, scaled_normals, vertex, triangle, least_cosine),
                                 mesh.material_of_triangle[triangle]});
    }
    shading.batches.back().corner_count += 3;
  }
  return shading;
}

}  // namespace depthgrid
