#include "eval/pictures/placed_path.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"

namespace depthgrid {
namespace {

StampedPose At(double stamp_s, const Pose2& base, double height_m) {
  return {stamp_s, CameraOf(base, height_m)};
}

// SLAM begins at its origin and goes 2 m ahead; in the map that is from (5, 6) to the left.
TEST(PlacedPath, BeginsWhereTheEstimateDoes) {
  const Trajectory slam = {At(0.0, {-1.0, 0.0, 0.0}, 1.2), At(1.0, {0.0, 0.0, 0.0}, 1.2),
                           At(2.0, {2.0, 0.0, 0.0}, 1.3)};
  // The first frame has no estimate.
  const Trajectory estimate = {At(1.0, {5.0, 6.0, kPi / 2.0}, 1.1),
                               At(2.0, {5.1, 8.0, kPi / 2.0}, 1.1)};
  const Trajectory placed = PlacedWhereItBegins(slam, estimate);
  ASSERT_EQ(placed.size(), 3u);
  const double expected_m[][3] = {{5.0, 5.0, 1.2}, {5.0, 6.0, 1.2}, {5.0, 8.0, 1.3}};
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Pose3& pose = placed[i].world_from_camera;
    EXPECT_EQ(placed[i].stamp_s, slam[i].stamp_s);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(pose.translation[axis], expected_m[i][axis], 1e-12) << i << " " << axis;
    }
    EXPECT_NEAR(BaseOf(pose).yaw_rad, kPi / 2.0, 1e-12) << i;
  }
}

TEST(PlacedPath, WithoutAPoseInCommonItStays) {
  const Trajectory slam = {At(0.0, {1.0, 2.0, 0.5}, 1.0)};
  const Trajectory placed = PlacedWhereItBegins(slam, {At(9.0, {5.0, 6.0, 0.0}, 1.0)});
  EXPECT_EQ(placed[0].world_from_camera, slam[0].world_from_camera);
  EXPECT_TRUE(PlacedWhereItBegins({}, {}).empty());
}

}  // namespace
}  // namespace depthgrid
