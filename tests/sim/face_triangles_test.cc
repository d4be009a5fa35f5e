#include "sim/mesh/face_triangles.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "mapper/core/rng.h"
#include "sim/mesh/mesh_file.h"
#include "sim/mesh/triangle_mesh.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

// The sum of the triangles' areas: more than the face's where they lie over each other or beside
// it.
double AreaOf(const Corners& corners) {
  double area = 0.0;
  const auto triangles = TrianglesOfFace(corners);
  for (const auto& [a, b, c] : *triangles) {
    area += 0.5 * (corners[b] - corners[a]).cross(corners[c] - corners[a]).norm();
  }
  return area;
}

Corners In3d(const std::vector<Eigen::Vector2d>& outline, const Eigen::Quaterniond& rotation) {
  Corners corners;
  for (const auto& p : outline) {
    const Eigen::Vector3d corner = rotation * Eigen::Vector3d(p.x(), p.y(), 0.7);
    corners.push_back(corner.cast<float>().cast<double>());  // as files hold it
  }
  return corners;
}

const Eigen::Quaterniond kTurn(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()));

TEST(TrianglesOfFace, OfAConvexFaceAreAFan) {
  const Corners square = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  using Triangle = std::array<std::uint32_t, 3>;
  EXPECT_EQ(TrianglesOfFace(square), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  // With a corner on a straight edge, and not quite flat.
  EXPECT_EQ(TrianglesOfFace(Corners{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0.1}, {0, 2, 0}}),
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(TrianglesOfFace, CoverAConcaveFaceOnce) {
  // An L, an arrowhead and a comb, from each corner, either way round, in any plane.
  std::vector<Eigen::Vector2d> comb = {{0, 0}, {9, 0}};
  for (int tooth = 4; tooth >= 0; --tooth) {
    comb.insert(comb.end(), {{2.0 * tooth + 1, 3}, {2.0 * tooth, 3}});
    if (tooth > 0) comb.insert(comb.end(), {{2.0 * tooth, 1}, {2.0 * tooth - 1, 1}});
  }
  const std::vector<std::pair<std::vector<Eigen::Vector2d>, double>> outlines = {
      {{{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 5}, {0, 5}}, 18.0},
      {{{0, 0}, {2, 1}, {0, 2}, {1, 1}}, 1.0},
      {comb, 9.0 + 5.0 * 2.0}};
  int faces = 0;
  for (const auto& [outline, area] : outlines) {
    for (std::size_t begin = 0; begin < outline.size(); ++begin) {
      auto turned = outline;
      std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(begin),
                  turned.end());
      EXPECT_NEAR(AreaOf(In3d(turned, kTurn)), area, 1e-5);
      std::reverse(turned.begin(), turned.end());
      EXPECT_NEAR(AreaOf(In3d(turned, kTurn)), area, 1e-5);
      faces += 2;
    }
  }
  EXPECT_EQ(faces, 2 * (6 + 4 + 20));
}

TEST(TrianglesOfFace, TurnAsTheFaceDoes) {
  Corners face = In3d({{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 5}, {0, 5}}, kTurn);
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Vector3d up = sign * (kTurn * Eigen::Vector3d::UnitZ());
    const auto triangles = TrianglesOfFace(face);
    ASSERT_EQ(triangles->size(), 4U);
    for (const auto& [a, b, c] : *triangles) {
      EXPECT_GT((face[b] - face[a]).cross(face[c] - face[a]).dot(up), 0.0);
    }
    std::reverse(face.begin(), face.end());
  }
}

TEST(TrianglesOfFace, OfAnythingComeToAnEnd) {
  EXPECT_EQ(TrianglesOfFace(Corners(7, {1, 2, 3}))->size(), 5U);
  EXPECT_EQ(TrianglesOfFace(Corners{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}})->size(), 2U);
  const double huge = std::numeric_limits<float>::max();
  EXPECT_EQ(TrianglesOfFace(Corners{{-huge, 0, 0}, {huge, huge, 0}, {0, 0, 0}, {huge, -huge, huge}})
                ->size(),
            2U);
  RandomStream random(7, RandomStage::kTest, 0);
  int faces = 0;
  for (int corners = 4; corners < 60; ++corners, ++faces) {
    Corners face;
    for (int i = 0; i < corners; ++i) {
      face.emplace_back(std::floor(4 * random.Uniform()), std::floor(4 * random.Uniform()),
                        corners % 2 == 0 ? 0.0 : random.Uniform());
    }
    EXPECT_EQ(TrianglesOfFace(face)->size(), face.size() - 2);
  }
  EXPECT_EQ(faces, 56);
  Corners star;
  for (int i = 0; i < 2002; ++i) {
    const double angle = 2.0 * M_PI * i / 2002, radius = i % 2 == 0 ? 1.0 : 2.0;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  EXPECT_FALSE(TrianglesOfFace(star).has_value());
  star.resize(kMostConcaveCorners);
  EXPECT_EQ(TrianglesOfFace(star)->size(), kMostConcaveCorners - 2);
}

class PlyFaces : public TemporaryFolderTest {};

TEST_F(PlyFaces, AreCutAsTheyLie) {
  const std::string vertices = "0 0 0\n6 0 0\n6 2 0\n2 2 0\n2 5 0\n0 5 0\n";
  const std::string of_vertices =
      "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string of_faces = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string head = "ply\nformat ascii 1.0\n", end = "end_header\n";
  const auto area = [&](const std::string& text) {
    Write("l.ply", text);
    const TriangleMesh mesh = ReadMeshFile(Path("l.ply")).mesh;
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) sum += ScaledNormal(mesh, i).norm() / 2;
    return sum;
  };
  const std::string face = "6 4 5 0 1 2 3\n";
  EXPECT_NEAR(area(head + of_vertices + of_faces + end + vertices + face), 18.0, 1e-6);
  EXPECT_NEAR(area(head + of_faces + of_vertices + end + face + vertices), 18.0, 1e-6);
  EXPECT_EQ(Short(RefusalOf(
                [&] { area(head + of_faces + of_vertices + end + "6 4 5 0 1 2 6\n" + vertices); })),
            "~/l.ply: face 0 uses vertex 6, must be below their number, 6");
}

}  // namespace
}  // namespace depthgrid
