// Laser logs whose poses are the robot's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/io/carmen_log.h"
#include "tests/io/log_text.h"

namespace depthgrid {
namespace {

constexpr char kTwoPoses[] = "FLASER 3 1.0 81.83 2.0 1 2 0.5 0.9 2 0.5 11.5 host 0.2\n";

// At (1, 2) looking along y; the laser is 0.5 m ahead and looks to the left of that.
TEST(CarmenMount, AMountMakesTheRobotsPoseTheLasers) {
  const TextFile file(
      "FLASER 2 1 1 1 2 1.5707963267948966 1 2 1.5707963267948966 1 h 1\n"
      "FLASER 2 1 1 1 3 1.5707963267948966 1 3 1.5707963267948966 2 h 2\n");
  CarmenLogOptions options;
  options.fov_deg = 90.0;
  options.mount = {0.5, 0.0, 90.0};
  // The robot's second pose in its first one's axes.
  const LoopClosure loop = {1, 0, 1, Lift(Pose2{1.0, 0.0, 0.0})};
  const auto source = OpenCarmenLog(file.path(), options, {loop});
  EXPECT_TRUE(source->Warnings().empty());
  const auto frames = ReadAll(*source);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_LT(Separation(BaseOf(*frames[0].slam_from_camera), {1.0, 2.5, kPi}), 1e-12);
  EXPECT_LT(Separation(BaseOf(*frames[1].slam_from_camera), {1.0, 3.5, kPi}), 1e-12);
  ASSERT_EQ(frames[1].loops.size(), 1U);
  const Pose3 second = *frames[0].slam_from_camera * frames[1].loops[0].first_from_second;
  EXPECT_LT(Separation(BaseOf(second), {1.0, 3.5, kPi}), 1e-12);
}

TEST(CarmenMount, AMountOfALaserThatStatesItsOwnPosesIsSaid) {
  CarmenLogOptions options;
  options.fov_deg = 90.0;
  EXPECT_EQ(WarningsOf(kTwoPoses, options), "");
  options.mount.x_m = 0.1;
  EXPECT_THAT(
      WarningsOf(kTwoPoses, options),
      ::testing::HasSubstr(":1: the line states two poses, the laser's and the robot's, 0.10 "
                           "m and 0 degrees apart (1 such line): sequence.laser.mount is "));
  EXPECT_EQ(WarningsOf(ScanAt(0.0, 0.0, 1), options), "");
}

}  // namespace
}  // namespace depthgrid
