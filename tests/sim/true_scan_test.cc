#include "sim/true_scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/level.h"

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

TEST(TrueScanner, NothingWithinRangeOnlyClears) {
  const TriangleMesh mesh = WallAndBox();
  TrueScanOptions near;
  near.max_range_m = 1.9;
  const TrueScanner scanner(mesh, 0.0, RayScene(mesh), kCamera, near);
  for (const Beam& beam : scanner.Slice(CameraOf({0.0, 0.0, 0.0}, 1.0)).beams) {
    EXPECT_FALSE(beam.hit);
    EXPECT_NEAR(beam.clear_to_m, 1.9, 1e-6);
  }
  // Behind the camera there is nothing at all.
  for (const Beam& beam : scanner.Obstacles(CameraOf({0.0, 0.0, kPi}, 1.0)).beams) {
    EXPECT_FALSE(beam.hit);
  }
}

}  // namespace
}  // namespace depthgrid
