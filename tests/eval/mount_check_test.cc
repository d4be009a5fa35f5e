#include "eval/doubts/mount_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// The map says that a laser on a robot at `mount` drives along a figure of eight, or a part of it;
// SLAM's poses are the robot's, of `scale` times the way and with their headings off by up to
// `wavers_rad`.
MappingRun Eight(const Pose2& mount, double share = 1.0, double scale = 1.0,
                 double wavers_rad = 0.0) {
  MappingRun run;
  constexpr int kFrames = 400;
  for (int i = 0; i <= share * kFrames; ++i) {
    const double at_rad = 2.0 * kPi * i / kFrames;
    const Pose2 robot = {2.0 * std::sin(at_rad), std::sin(2.0 * at_rad),
                         std::atan2(2.0 * std::cos(2.0 * at_rad), 2.0 * std::cos(at_rad))};
    FrameReport report;
    report.slam_from_camera =
        CameraOf({scale * robot.x_m, scale * robot.y_m,
                  WrapAngle(robot.yaw_rad + wavers_rad * std::sin(7.0 * at_rad))});
    run.reports.push_back(report);
    run.result.map_from_camera.emplace_back(CameraOf(robot * mount));
  }
  return run;
}

TEST(MountCheck, TellsALaserThatIsTurned) {
  for (const double deg : {-170.0, -45.0, 20.0, 90.0}) {
    const Pose2 mount = {0.0, 0.0, RadFromDeg(deg)};
    const auto told = MountDoubt(Eight(mount));
    ASSERT_TRUE(told) << deg;
    EXPECT_LT(Separation(*told, mount), 1e-3);
    EXPECT_FALSE(MountDoubt(Eight(mount, 0.1))) << deg;  // a short way
  }
  EXPECT_FALSE(MountDoubt(Eight({0.0, 0.0, RadFromDeg(5.0)})));
  EXPECT_FALSE(MountDoubt(MappingRun{}));
}

TEST(MountCheck, TellsALaserThatIsOff) {
  for (const Pose2& mount : {Pose2{0.3, 0.1, RadFromDeg(45.0)}, Pose2{-0.5, 0.2, RadFromDeg(180.0)},
                             Pose2{0.25, 0.0, 0.0}, Pose2{0.0, -1.5, RadFromDeg(-90.0)}}) {
    const auto told = MountDoubt(Eight(mount));
    ASSERT_TRUE(told) << mount.x_m;
    EXPECT_LT(Separation(*told, mount), 5e-3) << mount.x_m;
  }
  EXPECT_FALSE(MountDoubt(Eight({0.05, 0.05, 0.0})));
}

// Of a part without half a turn in it.
TEST(MountCheck, TellsNoPositionWithoutTurns) {
  const auto told = MountDoubt(Eight({0.0, 0.0, RadFromDeg(60.0)}, 0.2));
  ASSERT_TRUE(told);
  EXPECT_LT(told->translation().norm(), 1e-9);
  EXPECT_NEAR(told->yaw_rad, RadFromDeg(60.0), 0.02);
}

// Where a robot turns always alike, a turned laser and one on the other side of the circle's middle
// move alike.
TEST(MountCheck, TakesTheNearPositionOfMany) {
  MappingRun run;
  for (int i = 0; i <= 120; ++i) {
    const double at_rad = 2.0 * kPi * i / 120;
    const Pose2 robot = {std::sin(at_rad), 1.0 - std::cos(at_rad), WrapAngle(at_rad)};
    FrameReport report;
    report.slam_from_camera = CameraOf(robot);
    run.reports.push_back(report);
    run.result.map_from_camera.emplace_back(CameraOf(robot * Pose2{0.0, 0.0, 0.5}));
  }
  const auto told = MountDoubt(run);
  ASSERT_TRUE(told);
  EXPECT_LT(Separation(*told, {0.0, 0.0, 0.5}), 1e-3);
}

TEST(MountCheck, IsNotWhatOtherFaultsAre) {
  EXPECT_FALSE(MountDoubt(Eight({}, 1.0, 1.25)));
  EXPECT_FALSE(MountDoubt(Eight({}, 1.0, 1.0, 0.3)));
  EXPECT_FALSE(MountDoubt(Eight({0.3, 0.1, RadFromDeg(45.0)}, 1.0, 2.0)));  // of another scale
  MappingRun mirrored = Eight({});
  for (auto& pose : mirrored.result.map_from_camera) {
    const Pose2 p = BaseOf(*pose);
    pose = CameraOf({p.y_m, p.x_m, p.yaw_rad});
  }
  EXPECT_FALSE(MountDoubt(mirrored));
}

}  // namespace
}  // namespace depthgrid
