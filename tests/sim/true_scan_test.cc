#include "sim/truth/true_scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/level.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

// A level camera at 1 m looking along x at a wall at x = 3 m, with a box of 0.4 m height before it
// at x = 2 .. 2.4 m, y = -0.3 .. 0.3 m.
TriangleMesh WallAndBox() {
  TriangleMesh mesh;
  const auto add = [&mesh](const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                           const Eigen::Vector3f& c, const Eigen::Vector3f& d) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& corner : {a, b, c, d}) mesh.vertices.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  add({3, -4, 0}, {3, 4, 0}, {3, 4, 2}, {3, -4, 2});
  add({2, -0.3F, 0}, {2, 0.3F, 0}, {2, 0.3F, 0.4F}, {2, -0.3F, 0.4F});
  return mesh;
}

const PinholeCamera kCamera{640, 480, 481.2, 480.0, 319.5, 239.5};

TEST(TrueScanner, SeesTheBandFromAboveAndTheSliceAtItsHeight) {
  const TriangleMesh mesh = WallAndBox();
  const TrueScanner scanner(mesh, 0.0, RayScene(mesh), kCamera, {});
  const Pose3 camera = CameraOf({0.0, 0.0, 0.0}, 1.0);
  const Scan obstacles = scanner.Obstacles(camera);
  const Scan slice = scanner.Slice(camera);
  ASSERT_EQ(obstacles.beams.size(), 640U);
  ASSERT_EQ(slice.beams.size(), 640U);
  int on_box = 0;
  for (std::size_t i = 0; i < 640; ++i) {
    const Beam& low = obstacles.beams[i];
    const Beam& level = slice.beams[i];
    const double along = std::cos(low.bearing_rad);
    ASSERT_TRUE(low.hit && level.hit);
    EXPECT_NEAR(level.range_m * along, 3.0, 1e-5);  // over the box
    const bool box = std::abs(std::tan(low.bearing_rad)) < 0.15;
    EXPECT_NEAR(low.range_m * along, box ? 2.0 : 3.0, 1e-5);
    on_box += box ? 1 : 0;
    // The image's lower edge, 26.5 degrees down, meets the band's at 0.9 m / tan = 1.8 m.
    EXPECT_NEAR(low.clear_from_m * along, 0.9 / (239.5 + 0.5) * 480.0, 0.02);
    EXPECT_EQ(low.clear_to_m, low.range_m);
    EXPECT_NEAR(level.clear_from_m, 0.4, 1e-6);
    if (i > 0) {
      EXPECT_GT(low.bearing_rad, obstacles.beams[i - 1].bearing_rad);
    }
  }
  EXPECT_GT(on_box, 100);
}

// The image's lower edge falls, and its upper edge rises, by half the way ahead.
Beam StraightAhead(const TriangleMesh& obstacle, double camera_z_m, TrueScanOptions options = {}) {
  TriangleMesh mesh = WallAndBox();
  mesh.triangles.resize(2);  // the wall alone
  Append(mesh, obstacle);
  const TrueScanner scanner(mesh, 0.0, RayScene(mesh), kCamera, options);
  return scanner.Obstacles(CameraOf({0.0, 0.0, 0.0}, camera_z_m)).beams[320];
}

TEST(TrueScanner, WhatLiesBelowTheImageIsNotSeen) {
  // 0.4 m come into view at 1.2 m, the band's foot at 1.8 m.
  const Beam over = StraightAhead(test::Box({0.5F, -1, 0}, {0.9F, 1, 0.4F}), 1.0);
  EXPECT_TRUE(over.hit);
  EXPECT_NEAR(over.range_m, 3.0, 1e-4);
  EXPECT_NEAR(over.clear_from_m, 1.8, 1e-4);
  EXPECT_NEAR(over.clear_to_m, 3.0, 1e-4);
  const Beam onto = StraightAhead(test::Box({0.5F, -1, 0}, {2.2F, 1, 0.4F}), 1.0);
  EXPECT_TRUE(onto.hit);
  EXPECT_NEAR(onto.range_m, 1.2, 2e-3);
  EXPECT_EQ(onto.clear_to_m, 0.0F);
  const Beam behind = StraightAhead(test::Box({1.3F, -1, 0}, {2.2F, 1, 0.4F}), 1.0);
  EXPECT_TRUE(behind.hit);
  EXPECT_NEAR(behind.range_m, 1.3, 1e-4);
}

TEST(TrueScanner, WhatHangsAboveTheImageIsNotSeenNorFree) {
  // From 0.3 m the foot of the band is in view from 0.4 m on, at 1 m heights of up to 0.8 m.
  const Beam under = StraightAhead(test::Box({1.0F, -1, 1.0F}, {1.1F, 1, 1.2F}), 0.3);
  EXPECT_TRUE(under.hit);
  EXPECT_NEAR(under.range_m, 3.0, 1e-4);
  EXPECT_NEAR(under.clear_from_m, 0.4, 1e-4);
  EXPECT_NEAR(under.clear_to_m, 1.0, 1e-4);
}

TEST(TrueScanner, WhatIsTooNearToBeMeasuredHidesWhatIsBehind) {
  TrueScanOptions options;
  options.min_depth_m = 2.0;
  const Beam blocked = StraightAhead(test::Box({1.5F, -1, 0}, {1.6F, 1, 1.9F}), 1.0, options);
  EXPECT_FALSE(blocked.hit);
  EXPECT_EQ(blocked.clear_to_m, 0.0F);
}

TEST(TrueScanner, NothingWithinRangeOnlyClears) {
  const TriangleMesh mesh = WallAndBox();
  TrueScanOptions near;
  near.max_range_m = 1.9;
  const TrueScanner scanner(mesh, 0.0, RayScene(mesh), kCamera, near);
  const Scan before_wall = scanner.Slice(CameraOf({0.0, 0.0, 0.0}, 1.0));
  ASSERT_EQ(before_wall.beams.size(), 640U);
  for (const Beam& beam : before_wall.beams) {
    EXPECT_FALSE(beam.hit);
    EXPECT_NEAR(beam.clear_to_m, 1.9, 1e-6);
  }
  // Behind the camera there is nothing at all.
  const Scan turned_away = scanner.Obstacles(CameraOf({0.0, 0.0, kPi}, 1.0));
  ASSERT_EQ(turned_away.beams.size(), 640U);
  for (const Beam& beam : turned_away.beams) EXPECT_FALSE(beam.hit);
}

}  // namespace
}  // namespace depthgrid
