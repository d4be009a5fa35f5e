// Triangles as the colour camera draws them: three corners each, with normals that are
// smooth over curved surfaces and sharp at edges, grouped by texture.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/mesh/material.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

struct ShadingCorner {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;  // unit length; zero for a triangle without area
  std::uint32_t material = 0;
};

struct TextureBatch {
  TextureKind texture = TextureKind::kPlain;
  int first_corner = 0;
  int corner_count = 0;
};

struct ShadingMesh {
  std::vector<ShadingCorner> corners;
  std::vector<TextureBatch> batches;  // in the order of TextureKind
};

// Triangles that share a vertex and whose normals differ by less than this are shaded as one curved
// surface.
constexpr double kCreaseDeg = 40.0;

ShadingMesh MakeShadingMesh(const TriangleMesh& mesh, const std::vector<Material>& materials);

}  // namespace depthgrid
