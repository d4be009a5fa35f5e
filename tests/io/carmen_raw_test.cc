#include "mapper/io/carmen_raw.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "tests/io/log_text.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

std::string RawLine(double stamp_s) {
  return fmt::format("RAWLASER1 0 -0.5 1.0 0.5 6.000 0.01 0 3 2.5 6.0 0 2 7 8 {:.6f} h {:.6f}\n",
                     stamp_s, stamp_s);
}
std::string OdometryLine(double stamp_s, double x_m, double yaw_rad) {
  return fmt::format("ODOM {} {} {} 0 0 0 {:.6f} h {:.6f}\n", x_m, 10.0 * x_m, yaw_rad, stamp_s,
                     stamp_s);
}

std::vector<Frame> FramesOf(const std::string& text) {
  const TextFile file(text);
  return ReadAll(*OpenCarmenLog(file.path()));
}
Pose2 PoseOfFrame(const Frame& frame) { return BaseOf(*frame.slam_from_camera); }

TEST(CarmenRaw, PosesAreBetweenThoseOfTheOdometry) {
  // The heading goes the short way round.
  const auto frames =
      FramesOf("PARAM laser_type 1\n" + OdometryLine(1.0, 0.0, 3.0) + OdometryLine(1.4, 0.4, -3.0) +
               RawLine(1.1) + RawLine(1.4) + RawLine(1.5) + OdometryLine(1.8, 0.8, -3.0));
  ASSERT_EQ(frames.size(), 3U);
  const Pose2 first = PoseOfFrame(frames[0]);
  EXPECT_NEAR(first.x_m, 0.1, 1e-12);
  EXPECT_NEAR(first.y_m, 1.0, 1e-12);
  EXPECT_NEAR(first.yaw_rad, 3.0 + 0.25 * (2.0 * kPi - 6.0), 1e-12);
  EXPECT_NEAR(PoseOfFrame(frames[1]).x_m, 0.4, 1e-12);
  EXPECT_NEAR(PoseOfFrame(frames[2]).x_m, 0.5, 1e-12);
  ASSERT_EQ(frames[0].scan->beams.size(), 3U);
  EXPECT_EQ(frames[0].scan->beams[0], (Beam{-0.5F, 2.5F, 0.0F, 2.5F, true}));
  EXPECT_EQ(frames[0].scan->max_range_m, 6.0);
}

// The laser of a robot at (1, 2) that looks to the left.
TEST(CarmenRaw, TheLogSaysWhereTheLaserIs) {
  const std::string offsets =
      "PARAM robot_frontlaser_offset 0.3 0 h 0\nPARAM robot_frontlaser_side_offset 0.1 0 h 0\n"
      "PARAM robot_frontlaser_angular_offset -0.5 0 h 0\n";
  const std::string turned = "ODOM 1 2 1.5707963267948966 0 0 0 ";
  const std::string log = turned + "1.0 h 1.0\n" + RawLine(1.1) + turned + "1.2 h 1.2\n";
  const auto frames = FramesOf(offsets + log);
  ASSERT_EQ(frames.size(), 1U);
  const Pose2 laser = PoseOfFrame(frames[0]);
  EXPECT_NEAR(laser.x_m, 0.9, 1e-12);
  EXPECT_NEAR(laser.y_m, 2.3, 1e-12);
  EXPECT_NEAR(laser.yaw_rad, 0.5 * kPi - 0.5, 1e-12);
  EXPECT_THAT(
      WarningsOf(offsets + log),
      HasSubstr("around them with the laser at (0.3, 0.1) m, -28.6479 degrees to the left"));
  // A mount that is given replaces it; a scan before these lines has the robot's pose.
  const TextFile file(offsets + log);
  CarmenLogOptions options;
  options.mount.x_m = 0.2;
  const auto mounted = ReadAll(*OpenCarmenLog(file.path(), options));
  ASSERT_EQ(mounted.size(), 1U);
  EXPECT_NEAR(PoseOfFrame(mounted[0]).y_m, 2.2, 1e-12);
  EXPECT_NEAR(PoseOfFrame(FramesOf(log + offsets)[0]).x_m, 1.0, 1e-12);
}

TEST(CarmenRaw, ADamagedOffsetIsToldAndLeftOut) {
  const std::string log = OdometryLine(1.0, 0.0, 0.0) + RawLine(1.1) + OdometryLine(1.2, 0.0, 0.0);
  int told = 0;
  for (const auto& [value, rule] :
       {std::pair("offset 300", "offset is 300, must be 10 m at most"),
        std::pair("offset nan", "offset is nan, must be 10 m at most"),
        std::pair("side_offset", "side_offset is no number, must be 10 m at most"),
        std::pair("side_offset left", "side_offset is no number, must be 10 m at most"),
        std::pair("angular_offset 45", "angular_offset is 45, must be two pi radians at most")}) {
    const std::string damaged = "PARAM robot_frontlaser_" + std::string(value) + "\n" + log;
    EXPECT_THAT(WarningsOf(damaged), HasSubstr(std::string(":1: a damaged PARAM of the front "
                                                           "laser's place: robot_frontlaser_") +
                                               rule));
    EXPECT_EQ(PoseOfFrame(FramesOf(damaged)[0]), (Pose2{}));
    ++told;
  }
  EXPECT_EQ(told, 5);
}

TEST(CarmenRaw, OfALogWithOtherScansTheyAreNotRead) {
  const std::string scan =
      "ROBOTLASER1 0 -0.5 1 0.5 6 0.01 0 3 2.5 6.0 2 0 0 0 0 0 0 0 0 0 0 0 0 5.0 h 5.0\n";
  const std::string log = OdometryLine(1.0, 0.0, 0.0) + RawLine(1.1) + OdometryLine(1.2, 1.0, 0.0) +
                          "RAWLASER1 what\nODOM what\n" + scan;
  const auto frames = FramesOf(log);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].stamp_s, 5.0);
  EXPECT_EQ(WarningsOf(log), "");
  // Not even if those are all damaged.
  const TextFile damaged(OdometryLine(1.0, 0.0, 0.0) + RawLine(1.0) + "FLASER what\n");
  EXPECT_THAT(RefusalOf([&] { OpenCarmenLog(damaged.path()); }), HasSubstr("no usable FLASER"));
}

TEST(CarmenRaw, WithoutOdometryNearItAScanIsLeftOut) {
  const std::string log = RawLine(0.9) + OdometryLine(1.0, 0.0, 0.0) + RawLine(1.1) +
                          OdometryLine(1.2, 0.1, 0.0) + RawLine(1.5) + OdometryLine(2.0, 0.1, 0.0) +
                          OdometryLine(2.1, 30.0, 0.0) + RawLine(2.05) + RawLine(2.2);
  const auto frames = FramesOf(log);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].stamp_s, 1.1);
  EXPECT_EQ(frames[0].index, 0);
  const std::string said = WarningsOf(log);
  EXPECT_THAT(said, HasSubstr("scans are RAWLASER1 lines"));
  EXPECT_THAT(said, HasSubstr(":1: RAWLASER1 without odometry at its time: stamp 0.900000 is "
                              "before the first ODOM line's (4 such lines)"));
}

// The clock of both is set back by ten seconds, over what was there before.
TEST(CarmenRaw, AClockThatWasSetBackMixesNothing) {
  std::string log;
  for (int i = 0; i < 20; ++i) {
    const double stamp_s = i < 10 ? 10.0 + 0.2 * i : 0.1 + 0.2 * (i - 10) + 10.0;
    log += OdometryLine(stamp_s, 0.1 * i, 0.0) + RawLine(stamp_s + 0.1);
  }
  log += OdometryLine(12.1, 2.0, 0.0);
  const auto frames = FramesOf(log);
  ASSERT_EQ(frames.size(), 20U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i == 9) continue;  // where it was set back
    EXPECT_NEAR(PoseOfFrame(frames[i]).x_m, 0.05 + 0.1 * static_cast<double>(i), 1e-9) << i;
  }
}

TEST(CarmenRaw, OneClearLineForEachFault) {
  const auto refused = [](const std::string& text) {
    const TextFile file(text);
    const std::string said = RefusalOf([&] { OpenCarmenLog(file.path()); });
    return said.substr(said.find("first: ") == std::string::npos ? 0 : said.find("first: "));
  };
  const std::string odometry = OdometryLine(1.0, 0.0, 0.0) + OdometryLine(1.2, 0.0, 0.0);
  EXPECT_THAT(refused(RawLine(1.1)),
              HasSubstr(":1: RAWLASER1 without odometry at its time: the log "
                        "has no usable ODOM line"));
  EXPECT_THAT(refused(odometry + "RAWLASER1 0 -0.5 1.0 0.5 6 0.01 0 3 2.5 6.0 x 0 1.1 h 1\n"),
              HasSubstr(":3: RAWLASER1 with damaged readings: number 3 of 3 is 'x', must be"));
  EXPECT_THAT(refused(odometry + "RAWLASER1 0 -90 180 0.5 6 0.01 0 3 2.5 6.0 1 0 1.1 h 1\n"),
              HasSubstr(":3: RAWLASER1 with impossible angles: the start angle is -90"));
  EXPECT_THAT(refused(odometry + "RAWLASER1 0 -0.5 1.0 0.5 6 0.01 0 3 2.5 6.0 1 0\n"),
              HasSubstr(":3: RAWLASER1 without a time: it is missing"));
  EXPECT_THAT(refused(odometry + "RAWLASER1 0 -0.5 1 0.5 6 0.01 0 3 2 6 1 0 1.1e18 h 1\n"),
              HasSubstr(":3: RAWLASER1 with a time that is not in seconds"));
  EXPECT_THAT(WarningsOf("ODOM 1 2 x 0 0 0 1.1 h 1\n" + odometry + RawLine(1.1)),
              HasSubstr(":1: ODOM with a damaged pose"));
}

}  // namespace
}  // namespace depthgrid
