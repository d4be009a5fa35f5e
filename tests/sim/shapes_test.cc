// Every primitive is closed, faces outward, and encloses the volume its formula says.
#include "sim/shapes/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "mapper/core/angle.h"
#include "mapper/core/rng.h"
#include "sim/depth/ray_scene.h"
#include "sim/mesh/polygon.h"
#include "sim/shapes/box.h"
#include "sim/shapes/revolve.h"
#include "sim/shapes/superellipsoid.h"
#include "sim/shapes/sweep_shapes.h"
#include "sim/shapes/wall.h"
#include "tests/refusal.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

// Closed and consistently oriented: each edge is used once in each direction.
bool IsClosed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : uses) {
    const auto back = uses.find({edge.second, edge.first});
    if (count != 1 || back == uses.end() || back->second != 1) return false;
  }
  return !mesh.triangles.empty();
}

bool HasAreaEverywhere(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!(ScaledNormal(mesh, i).norm() > 0.0)) return false;
  }
  return true;
}

// Area of the regular polygon with n corners on the unit circle.
double RegularArea(int n) { return 0.5 * n * std::sin(2.0 * kPi / n); }

void ExpectSolid(const TriangleMesh& mesh, double volume_m3, double relative_tolerance) {
  EXPECT_TRUE(IsClosed(mesh));
  EXPECT_TRUE(HasAreaEverywhere(mesh));
  EXPECT_EQ(mesh.triangles.size(), mesh.material_of_triangle.size());
  EXPECT_NEAR(test::SignedVolume(mesh), volume_m3, relative_tolerance * volume_m3);
}

constexpr double kExact = 2e-6;  // float vertices

TEST(Shapes, BoxStandsOnItsFoot) {
  const TriangleMesh box = MakeBox({1.0, 2.0, 3.0});
  ExpectSolid(box, 6.0, kExact);
  EXPECT_EQ(BoundsOf(box).min(), Eigen::Vector3f(-0.5F, -1.0F, 0.0F));
  EXPECT_EQ(BoundsOf(box).max(), Eigen::Vector3f(0.5F, 1.0F, 3.0F));
}

TEST(Shapes, RoundedBoxLosesItsEdges) {
  const double r = 0.2;
  const Eigen::Vector3d size(1.0, 1.5, 0.8);
  const Eigen::Vector3d core = size - Eigen::Vector3d::Constant(2 * r);
  // Steiner's formula for the core grown by r.
  const double volume = core.prod() +
                        2 * r * (core.x() * core.y() + core.y() * core.z() + core.z() * core.x()) +
                        kPi * r * r * core.sum() + 4.0 / 3.0 * kPi * r * r * r;
  ExpectSolid(MakeRoundedBox(size, r, 24), volume, 2e-4);
  EXPECT_TRUE(IsClosed(MakeRoundedBox(size, r, 1)));
  const Eigen::AlignedBox3f bounds = BoundsOf(MakeRoundedBox(size, r, 4));
  EXPECT_NEAR(bounds.min().z(), 0.0, 1e-7);
  EXPECT_NEAR(bounds.max().z(), 0.8, 1e-7);
  EXPECT_NEAR(bounds.max().x(), 0.5, 1e-7);
}

TEST(Shapes, TurnedSolidsAreInscribed) {
  for (const int n : {3, 7, 32}) {
    ExpectSolid(Revolve(FrustumOutline(0.5, 0.5, 2.0), n), RegularArea(n) * 0.25 * 2.0, kExact);
    ExpectSolid(Revolve(FrustumOutline(0.6, 0.0, 1.5), n), RegularArea(n) * 0.36 * 0.5, kExact);
    // (h / 3) (A1 + A2 + sqrt(A1 A2))
    ExpectSolid(Revolve(FrustumOutline(0.6, 0.3, 1.5), n), RegularArea(n) * 0.5 * 0.63, kExact);
  }
  ExpectSolid(Revolve(SphereOutline(0.5, 256), 256), kPi / 6.0, 3e-4);
  ExpectSolid(Revolve(TorusOutline(1.0, 0.25, 128), 256), 2.0 * kPi * kPi * 0.0625, 1e-3);
  // A thick ring, its outline given clockwise: Pappus, on the polygon.
  const LatheOutline ring = {{1.0, 0.0}, {1.0, 0.5}, {1.5, 0.5}, {1.5, 0.0}};
  ExpectSolid(Revolve(ring, 16), RegularArea(16) * (2.25 - 1.0) * 0.5, kExact);
}

TEST(Shapes, SuperellipsoidHasBarrsVolume) {
  const auto beta = [](double a, double b) {
    return std::tgamma(a) * std::tgamma(b) / std::tgamma(a + b);
  };
  const Eigen::Vector3d size(1.0, 0.6, 0.4);
  for (const double upright : {0.3, 1.0, 1.6}) {
    for (const double level : {0.3, 1.0, 1.6}) {
      const double volume = 2.0 * size.prod() / 8.0 * upright * level *
                            beta(upright / 2 + 1, upright) * beta(level / 2, level / 2);
      ExpectSolid(MakeSuperellipsoid(size, upright, level, 256), volume, 5e-3);
    }
  }
  EXPECT_NEAR(BoundsOf(MakeSuperellipsoid(size, 0.4, 0.4, 32)).max().x(), 0.5, 1e-6);
}

TEST(Shapes, PrismHasItsOutlinesArea) {
  const Polygon arrow = {{0, 0}, {2, 1}, {0, 2}, {0.5, 1}};  // not convex
  ExpectSolid(MakePrism(arrow, 0.3), SignedArea(arrow) * 0.3, kExact);
  const Polygon clockwise = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  ExpectSolid(MakePrism(clockwise, 2.0), 2.0, kExact);
  const Polygon with_straight_corner = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
  ExpectSolid(MakePrism(with_straight_corner, 1.0), 2.0, kExact);
}

TEST(Shapes, TubesFollowTheirPath) {
  TubeShape straight{{{0, 0, 0}, {0, 0, 1}, {0, 0, 3}}, 0.1, 0.1, false, 0, 24};
  ExpectSolid(MakeTube(straight), RegularArea(24) * 0.01 * 3.0, kExact);
  TubeShape bent{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}, 0.02, 0.02, false, 4, 24};
  const TriangleMesh bent_mesh = MakeTube(bent);
  EXPECT_TRUE(IsClosed(bent_mesh));
  EXPECT_GT(test::SignedVolume(bent_mesh), 0.0);
  EXPECT_NEAR(BoundsOf(bent_mesh).max().z(), 1.0, 1e-6);  // corner cutting keeps the ends
  TubeShape hoop{{}, 0.01, 0.01, true, 0, 16};
  for (int i = 0; i < 256; ++i) {
    const double angle = 2.0 * kPi * i / 256;
    hoop.path.emplace_back(std::cos(angle), std::sin(angle), 0.2 * std::sin(3 * angle));
  }
  EXPECT_TRUE(IsClosed(MakeTube(hoop)));
  EXPECT_TRUE(HasAreaEverywhere(MakeTube(hoop)));
  for (auto& point : hoop.path) point.z() = 0.0;
  ExpectSolid(MakeTube(hoop), 2.0 * kPi * RegularArea(16) * 1e-4, 1e-3);
}

TriangleMesh Built(const std::string& name, const std::string& text) {
  Config config = Config::FromText(text, "x");
  return BuildShape(name, config).mesh;
}

// Rounded where its wall meets top and bottom, as flat as before about the axis.
TEST(Shapes, ASmoothLatheHasNoPitAtItsAxis) {
  const TriangleMesh drum =
      Built("lathe", "shape: lathe\noutline: [[0, 0], [1, 0], [1, 2], [0, 2]]\nsmooth: 3\n");
  EXPECT_TRUE(IsClosed(drum));
  int within = 0;
  for (const Eigen::Vector3f& vertex : drum.vertices) {
    if (vertex.head<2>().norm() > 0.5F) continue;
    EXPECT_TRUE(vertex.z() == 0.0F || vertex.z() == 2.0F) << vertex.transpose();
    ++within;
  }
  EXPECT_EQ(within, 2 + 2 * 32);  // the ends of the axis and a ring around each
  EXPECT_LT(test::SignedVolume(drum), RegularArea(32) * 2.0);
  EXPECT_GT(test::SignedVolume(drum), 0.8 * RegularArea(32) * 2.0);
}

TEST(Shapes, ATubeThatFoldsBackIsRefused) {
  const auto refusal = [](const std::string& path) {
    return RefusalOf([&] { Built("tube", "shape: tube\n" + path); });
  };
  EXPECT_EQ(refusal("path: [[0, 0, 0], [0.5, 0, 0], [1, 0, 0], [0.25, 0, 0]]"),
            "x: path turns straight back at [1, 0, 0]");
  EXPECT_EQ(refusal("path: [[0, 0, 0], [1, 0, 0], [2, 0, 0]]\nclosed: true"),
            "x: path turns straight back at [2, 0, 0]");
  EXPECT_EQ(refusal("path: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0]]\nclosed: true"),
            "x: path has the same point twice in a row");
  EXPECT_EQ(refusal("path: [[0, 0, 0], [1, 0, 0], [0, 0, 0.001]]"), "no error");
}

TEST(Shapes, ClothAndLeavesAreThinSolids) {
  const CurtainShape flat{1.0, 2.0, 1e-6, 0.01, 4, 16};
  ExpectSolid(MakeCurtain(flat), 0.02, 1e-4);
  const TriangleMesh wavy = MakeCurtain({1.0, 2.0, 0.1, 0.004, 6, 32});
  EXPECT_TRUE(IsClosed(wavy));
  EXPECT_GT(test::SignedVolume(wavy), 0.008);  // longer than it is wide
  const LeafShape leaf_shape{0.4, 0.1, 0.004, 90.0, 24};
  const TriangleMesh leaf = MakeLeaf(leaf_shape);
  EXPECT_TRUE(IsClosed(leaf));
  // A rhombus of half width times thickness, its width averaged over the blade.
  double mean_square = 0.0;
  for (int i = 0; i < 10000; ++i) {
    mean_square += std::pow(std::sin(kPi * std::pow((i + 0.5) / 10000, 0.7)), 2) / 10000;
  }
  EXPECT_NEAR(test::SignedVolume(leaf), 0.5 * 0.1 * 0.004 * 0.4 * mean_square, 3e-7);
}

TEST(Polygons, TrianglesCoverThePolygonOnce) {
  RandomStream random(1, RandomStage::kTest);
  int cases = 0;
  for (; cases < 200; ++cases) {
    const int n = 3 + static_cast<int>(random.Below(40));
    Polygon star;
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * kPi * (i + random.Uniform(0.0, 0.8)) / n;
      const double radius = random.Uniform(0.2, 1.0);
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    ASSERT_TRUE(SignedArea(star) < 0.0 || IsSimple(star));
    const auto triangles = Triangulate(star);
    ASSERT_EQ(triangles.size(), star.size() - 2);
    double area = 0.0;
    for (const auto& t : triangles) {
      const double part = SignedArea({star[t[0]], star[t[1]], star[t[2]]});
      EXPECT_GE(part, 0.0);
      area += part;
    }
    EXPECT_NEAR(area, SignedArea(star), 1e-12);
  }
  EXPECT_EQ(cases, 200);
}

TEST(Polygons, CrossingOnesAreFound) {
  EXPECT_TRUE(IsSimple({{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  EXPECT_FALSE(IsSimple({{0, 0}, {1, 1}, {1, 0}, {0, 1}}));          // bow tie
  EXPECT_FALSE(IsSimple({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}));  // touches its own edge
  EXPECT_FALSE(IsSimple({{0, 0}, {2, 0}, {1, 0}}));                  // no area
  EXPECT_FALSE(IsSimple({{0, 0}, {2, 0}, {1, 0}, {1, 1}}));          // folds back
  EXPECT_FALSE(IsSimple({{0, 0}, {1, 0}}));
}

TEST(Walls, OpeningsAreCutOutAndClosed) {
  const double volume = 0.1 * (4.0 * 2.5 - 0.9 * 2.0 - 1.2 * 1.0);
  const TriangleMesh wall =
      MakeWall(4.0, 2.5, -0.1, 0.1, {{0.5, 0.0, 0.9, 2.0}, {2.2, 0.9, 1.2, 1.0}});
  ExpectSolid(wall, volume, kExact);
  const RayScene rays(wall);
  const auto passes = [&](float x, float z) { return !rays.Occluded({x, -1, z}, {x, 1, z}); };
  EXPECT_TRUE(passes(0.9F, 1.0F));
  EXPECT_TRUE(passes(2.8F, 1.4F));
  EXPECT_FALSE(passes(0.9F, 2.1F));
  EXPECT_FALSE(passes(0.45F, 1.0F));
  EXPECT_FALSE(passes(2.8F, 0.8F));
  EXPECT_FALSE(passes(1.8F, 1.0F));
}

TEST(Walls, OverlappingOpeningsMerge) {
  const TriangleMesh wall =
      MakeWall(4.0, 2.5, -0.05, 0.1, {{1.0, 0.0, 1.0, 2.0}, {1.5, 0.5, 1.0, 1.0}});
  ExpectSolid(wall, 0.1 * (10.0 - 2.0 - 0.5), kExact);
}

TEST(Placements, StepsTurnAndShift) {
  ItemOptions item;
  item.at = {1, 0, 2};
  item.yaw_deg = 90;
  item.scale = 2;
  item.count = 4;
  item.step_yaw_deg = 90;
  item.step = {0, 0, 0.5};
  const auto placements = PlacementsOf(item);
  ASSERT_EQ(placements.size(), 4U);
  EXPECT_TRUE((placements[0] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 2, 2)));
  EXPECT_TRUE((placements[1] * Eigen::Vector3d(0, 0, 0)).isApprox(Eigen::Vector3d(0, 1, 2.5)));
  EXPECT_TRUE((placements[2] * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(-1, 0, 5)));
  EXPECT_TRUE((placements[3] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(2, -1, 3.5)));
}

TEST(Placements, RollPitchYawTurnAboutFixedAxes) {
  ItemOptions item;
  item.rpy_deg = {90, 0, 90};
  // y -> z by the roll, which the yaw leaves; z -> -y by the roll, -> x by the yaw.
  const auto placement = PlacementsOf(item).front();
  EXPECT_TRUE((placement * Eigen::Vector3d(0, 1, 0)).isApprox(Eigen::Vector3d(0, 0, 1)));
  EXPECT_TRUE((placement * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(1, 0, 0)));
}

// A minimal item of each kind, so that every builder runs with its defaults.
TEST(Shapes, EveryKindOfTheFileIsASolid) {
  const std::map<std::string, std::string> needs = {
      {"lathe", "outline: [[0, 0], [1, 0], [0, 1]]"},
      {"prism", "outline: [[0, 0], [1, 0], [0, 1]]"},
      {"tube", "path: [[0, 0, 0], [0, 0, 1]]"},
      {"wall", "openings: [{along_m: 0.2, width_m: 0.3, height_m: 1.0}]"}};
  for (const auto& name : ShapeNames()) {
    const auto need = needs.find(name);
    const std::string text =
        "shape: " + name + "\n" + (need == needs.end() ? "" : need->second + "\n");
    Config config = Config::FromText(text, "x");
    const BuiltItem built = BuildShape(name, config);
    EXPECT_TRUE(IsClosed(built.mesh)) << name;
    EXPECT_GT(test::SignedVolume(built.mesh), 0.0) << name;
  }
}

}  // namespace
}  // namespace depthgrid
