#include "mapper/scan/floor_plane.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "mapper/core/angle.h"
#include "mapper/core/rng.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

bool IsLevel(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const Eigen::Vector3f d = b - a;
  return d.z() * d.z() <= 0.4F * 0.4F * (d.x() * d.x() + d.y() * d.y());
}

// One by one: every so many pixels, 0.1 to 3 m below the camera, up to 5 m away, level to the
// second point to the right and below.
std::vector<Eigen::Vector3f> PlainPoints(const DepthImage& image, const PinholeCamera& camera,
                                         const Eigen::Quaterniond& level) {
  const int step = std::max(1, std::max(image.width_px, image.height_px) / 80);
  const Eigen::Matrix3f rotation = level.toRotationMatrix().cast<float>();
  const Eigen::Vector3f ray_step = rotation.col(0) * static_cast<float>(step / camera.fx_px);
  const auto at = [&](int row, int column) -> Eigen::Vector3f {
    const Eigen::Vector3f first = rotation * Unproject(camera, 0.0, row * step, 1.0).cast<float>();
    const float z_m = image.Row(row * step)[column * step];
    return (z_m > 0.0F ? z_m : std::nanf("")) * (first + static_cast<float>(column) * ray_step);
  };
  std::vector<Eigen::Vector3f> points;
  for (int row = 0; row + 2 < image.height_px / step; ++row) {
    for (int column = 0; column + 2 < image.width_px / step; ++column) {
      const Eigen::Vector3f point = at(row, column);
      if (point.z() <= -0.1F && point.z() > -3.0F && point.head<2>().squaredNorm() <= 25.0F &&
          IsLevel(point, at(row, column + 2)) && IsLevel(point, at(row + 2, column))) {
        points.push_back(point);
      }
    }
  }
  return points;
}

TEST(LevelPoints, AreThoseOfThePlainLoopBitForBit) {
  AnalyticRoom room;
  room.boxes.push_back({{0.9, -1.0, 0.0}, {1.5, -0.3, 0.5}});
  const std::vector<PinholeCamera> cameras = {{640, 480, 525.0, 525.0, 319.5, 239.5, {}},
                                              {170, 120, 120.3, 120.0, 79.5, 59.5, {}},
                                              {37, 23, 30.0, 30.0, 18.0, 11.0, {}},
                                              {2, 480, 400.0, 400.0, 0.5, 239.5, {}}};
  RandomStream random(7, RandomStage::kTest);
  std::size_t points = 0;
  LevelPoints memory;
  for (int i = 0; i < 24; ++i) {
    const PinholeCamera& camera = cameras[static_cast<std::size_t>(i) % cameras.size()];
    const Pose3 pose = TiltedCamera({-1.0, 0.1, random.Uniform(-0.5, 0.5)}, 1.15,
                                    random.Uniform(-0.2, 0.6), random.Uniform(-0.3, 0.3));
    DepthImage image = room.Render(camera, pose);
    for (float& z_m : image.z_m) {
      z_m *= static_cast<float>(1.0 + 0.01 * random.Normal());
      if (random.Uniform() < 0.05) z_m = kInvalidDepth;
    }
    const Eigen::Quaterniond level = LevelFromCamera(pose);
    const std::vector<Eigen::Vector3f> plain = PlainPoints(image, camera, level);
    for (const std::int64_t target : {std::int64_t{0}, std::int64_t{HWY_AVX2}}) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      memory = LevelPointsOf(image, camera, level, std::move(memory));
      ASSERT_EQ(memory.points, plain) << i;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    points += plain.size();
  }
  EXPECT_GE(points, 3000U);
}

// Points 2 cm apart on a level square, `height_m` below the camera and tilted about the y axis.
void AddSquare(double x_m, double side_m, double height_m, double tilt_rad, LevelPoints& level) {
  for (double x = x_m; x < x_m + side_m; x += 0.02) {
    for (double y = -side_m / 2.0; y < side_m / 2.0; y += 0.02) {
      level.points.emplace_back(x, y, -height_m + std::tan(tilt_rad) * x);
    }
  }
}

TEST(LevelSurfaces, AreThoseThatFillAPartOfTheImage) {
  LevelPoints level;
  AddSquare(1.0, 1.0, 1.2, 0.0, level);
  AddSquare(2.0, 0.5, 0.75, 0.0, level);
  AddSquare(2.0, 0.1, 0.4, 0.0, level);
  level.samples = 4800;
  const std::vector<LevelSurface> surfaces = LevelSurfaces(level);
  ASSERT_EQ(surfaces.size(), 2U);
  EXPECT_NEAR(surfaces[0].height_m, 1.2, 0.02);
  EXPECT_EQ(surfaces[0].points, 2500);
  EXPECT_NEAR(surfaces[1].height_m, 0.75, 0.02);
  EXPECT_TRUE(LevelSurfaces({{}, 4800, {}}).empty());
}

// Half of the view is a rug; the floor before and behind it is tilted by 3 degrees.
TEST(FloorPlanes, AreFoundBesideARug) {
  const double tilt_rad = RadFromDeg(3.0);
  LevelPoints level;
  AddSquare(1.0, 1.0, 1.2, tilt_rad, level);
  AddSquare(2.0, 1.0, 1.12, tilt_rad, level);
  AddSquare(3.0, 1.0, 1.2, tilt_rad, level);
  level.samples = 9600;
  const FloorPrior prior{1.1, 0.1, RadFromDeg(2.0)};
  const auto found = FindFloorPlane(level, prior);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->height_m, 1.2, 0.01);
  EXPECT_NEAR(std::acos(found->up.z()), tilt_rad, RadFromDeg(0.2));
  EXPECT_EQ(found->points, 5000);
}

TEST(FloorPlanes, NeedPoints) {
  LevelPoints level;
  level.samples = 4800;
  EXPECT_FALSE(FitFloor(level, {1.0, 0.1, 0.03}));
  EXPECT_FALSE(FindFloorPlane(level, {1.0, 0.1, 0.03}));
}

}  // namespace
}  // namespace depthgrid
