#include "mapper/core/pose2.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

Pose2 RandomPose(RandomStream& random, double scale) {
  return {random.Uniform(-scale, scale), random.Uniform(-scale, scale),
          random.Uniform(-1.0, 1.0) * kPi * std::min(scale, 1.0)};
}

void ExpectNear(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x_m, b.x_m, tolerance);
  EXPECT_NEAR(a.y_m, b.y_m, tolerance);
  EXPECT_NEAR(WrapAngle(a.yaw_rad - b.yaw_rad), 0.0, tolerance);
}

TEST(Pose2, ComposesByHand) {
  const Pose2 quarter_turn{1.0, 2.0, kPi / 2};
  ExpectNear(quarter_turn * Pose2{1.0, 0.0, kPi / 2}, {1.0, 3.0, kPi}, 1e-15);
}

TEST(Pose2, GroupLawsHoldInThreeRegimes) {
  RandomStream random(1, RandomStage::kTest);
  int cases = 0;
  for (const double scale : {1e-12, 1e-8, 10.0}) {
    for (int i = 0; i < 100; ++i, ++cases) {
      const Pose2 a = RandomPose(random, scale);
      const Pose2 b = RandomPose(random, scale);
      const Pose2 c = RandomPose(random, scale);
      ExpectNear((a * b) * c, a * (b * c), 1e-13);
      ExpectNear(a * Inverse(a), {}, 1e-14);
      ExpectNear(a * Between(a, b), b, 1e-13);
    }
  }
  EXPECT_EQ(cases, 300);
}

TEST(WrapAngle, LiesInHalfOpenInterval) {
  EXPECT_EQ(WrapAngle(-kPi), kPi);
  EXPECT_EQ(WrapAngle(kPi), kPi);
  EXPECT_NEAR(WrapAngle(3 * kPi / 2), -kPi / 2, 1e-15);
  EXPECT_EQ(WrapAngle(0.25), 0.25);
}

TEST(Level, BaseIsTheInverseOfCamera) {
  RandomStream random(2, RandomStage::kTest);
  for (int i = 0; i < 100; ++i) {
    const Pose2 base = RandomPose(random, 5.0);
    const Pose3 camera = CameraOf(base, 1.15);
    ExpectNear(BaseOf(camera), base, 1e-14);
    const Eigen::Vector3d up = LevelFromCamera(camera) * -Eigen::Vector3d::UnitY();
    EXPECT_NEAR(up.z(), 1.0, 1e-14);
  }
}

TEST(Level, RelativePoseOfTiltedCamerasIsThatOfTheirBases) {
  RandomStream random(3, RandomStage::kTest);
  for (int i = 0; i < 100; ++i) {
    const auto tilted = [&] {
      const Pose3 level = CameraOf(RandomPose(random, 5.0), random.Uniform(0.5, 2.0));
      const Eigen::Quaterniond tilt(
          Eigen::AngleAxisd(random.Uniform(-0.5, 0.5), Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(random.Uniform(-0.5, 0.5), Eigen::Vector3d::UnitZ()));
      return level * Pose3{tilt, Eigen::Vector3d::Zero()};
    };
    const Pose3 i_pose = tilted();
    const Pose3 j_pose = tilted();
    ExpectNear(ProjectRelative(i_pose, j_pose, Between(i_pose, j_pose)),
               Between(BaseOf(i_pose), BaseOf(j_pose)), 1e-12);
  }
}

}  // namespace
}  // namespace depthgrid
