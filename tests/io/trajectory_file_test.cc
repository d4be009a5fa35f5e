#include "mapper/io/trajectory_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;

std::string TrajectoryFileRefusal(const std::string& text) {
  return RefusalOf([&] { ParseTrajectory(text, "t.txt"); });
}

TEST(TrajectoryFile, ReadsCommentsTabsCommasAndWindowsLines) {
  const TrajectoryFile file = ParseTrajectory(
      "\xEF\xBB\xBF# stamp tx ...\n\n1.5 1 2 3 0 0 0 1\r\n2.5,\t-1e-3, 2, 3, 0, 0, 0.6, 0.8\n",
      "x");
  ASSERT_EQ(file.poses.size(), 2U);
  EXPECT_EQ(file.poses[0].stamp_s, 1.5);
  EXPECT_EQ(file.poses[1].world_from_camera.translation, Eigen::Vector3d(-1e-3, 2, 3));
  EXPECT_EQ(file.poses[1].world_from_camera.rotation.z(), 0.6);
  EXPECT_THAT(file.Warnings("x"), ElementsAre());
}

TEST(TrajectoryFile, PrintsShortestNumbersWithOneSpace) {
  const Trajectory trajectory = {
      {1305031102.1753039, {Eigen::Quaterniond(0.8, 0, 0, -0.6), {0.1, -2.0, 1e-7}}}};
  EXPECT_EQ(TrajectoryText(trajectory), "1305031102.175304 0.1 -2 1e-07 0 0 -0.6 0.8\n");
}

TEST(TrajectoryFile, RoundTripIsExact) {
  RandomStream random(3, RandomStage::kTest);
  Trajectory trajectory;
  for (int i = 0; i < 1000; ++i) {
    Eigen::Vector4d q(random.Normal(), random.Normal(), random.Normal(), random.Normal());
    q.normalize();
    trajectory.push_back(
        {i / 64.0, {Eigen::Quaterniond(q), {random.Normal(), random.Normal(), 1e-9}}});
  }
  EXPECT_EQ(ParseTrajectory(TrajectoryText(trajectory), "x").poses, trajectory);
}

TEST(TrajectoryFile, SurvivesAndCountsBadRows) {
  const TrajectoryFile file = ParseTrajectory(
      "3 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n3 9 0 0 0 0 0 1\n4 nan 0 0 0 0 0 1\n"
      "5 0 0 0 0 0 0 0\n6 0 0 0 NaN 0 0 1\n7 0 inf 0 0 0 0 1\n8 0 -2e7 0 0 0 0 1\n",
      "x");
  ASSERT_EQ(file.poses.size(), 2U);
  EXPECT_EQ(file.poses[0].stamp_s, 1.0);
  EXPECT_EQ(file.poses[1].world_from_camera.translation.x(), 0.0);  // the first of stamp 3
  EXPECT_THAT(
      file.Warnings("t"),
      ElementsAre("t: 5 poses with NaN, a zero quaternion or beyond 10,000 km ignored "
                  "(first: x:4: the position is (nan, 0, 0), must be finite and within 10,000 km)",
                  "t: 1 row earlier than the row before, sorted",
                  "t: 1 row with a stamp already given, ignored (first: x:3: stamp 3)"));
}

TEST(TrajectoryFile, OneWithoutAnyUsableRowSaysWhy) {
  const auto refusal = [](const std::string& text) {
    std::vector<std::string> warnings;
    return RefusalOf([&] { PosesOf(ParseTrajectory(text, "t.txt"), "t.txt", warnings); });
  };
  EXPECT_EQ(refusal("# stamp\n"), "t.txt: holds no pose");
  EXPECT_EQ(refusal("# stamp\n1 1e12 2.5 0 0 0 0 1\n2 0 inf 0 0 0 0 1\n"),
            "t.txt: holds no pose that can be used, all 2 are left out; first: t.txt:2: the "
            "position is (1e+12, 2.5, 0), must be finite and within 10,000 km");
  EXPECT_EQ(refusal("1 0 0 0 0 0 0 0\n"),
            "t.txt: holds no pose that can be used, the only one is left out; first: t.txt:1: "
            "quaternion qx qy qz qw has norm 0, must be 1");
}

TEST(TrajectoryFile, StampsMustBeSeconds) {
  const std::string row = " 0 0 0 0 0 0 1\n";
  EXPECT_EQ(ParseTrajectory("1700000000.5" + row, "x").poses.size(), 1U);
  EXPECT_THAT(RefusalOf([&] {
                ParseTrajectory("1700000000000000000" + row + "1700000000100000000" + row, "x");
              }),
              testing::HasSubstr("x:1: the stamp is 1.7e+18, must be in seconds"));
}

TEST(TrajectoryFile, SurvivesDamageInsideALongFile) {
  const std::string good = "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n";
  const TrajectoryFile file = ParseTrajectory("0.5 x\n" + good + "4 0 0 0 0 1", "t");
  EXPECT_EQ(file.poses.size(), 3U);
  EXPECT_THAT(file.Warnings("t"), ElementsAre("t: 2 damaged rows left out (first: t:1: has 2 "
                                              "columns, must have 8)"));
  EXPECT_THAT(ParseTrajectory(good + "4 0 0 0 0 0 0 1", "t").Warnings("t"),
              ElementsAre("t: the last line has no line end; it is used, but may be cut"));
  EXPECT_EQ(TrajectoryFileRefusal("0 1\n0 1\n0 1\n" + good), "t.txt:1: has 2 columns, must have 8");
}

TEST(TrajectoryFile, NamesTheBadLine) {
  EXPECT_EQ(TrajectoryFileRefusal("# c\n1 2 3\n"), "t.txt:2: has 3 columns, must have 8");
  EXPECT_EQ(TrajectoryFileRefusal("# c\n1;2;3;4;5;6;7;8\n"),
            "t.txt:2: has semicolons between its columns, must have spaces or commas");
  EXPECT_EQ(TrajectoryFileRefusal("1,5 0 0 0 0 0 0 1\n2,5 0,5 0 0 0 0 0 1\n3 0,5 0 0 0 0 0 1\n"),
            "t.txt:1: has decimal commas, must have decimal points");
  EXPECT_EQ(TrajectoryFileRefusal("1, 0, 0, 0, 0, 0, 0, 1\n2,1,0,0,0,0,0,1\n"), "no error");
  EXPECT_EQ(TrajectoryFileRefusal("1 0 0 0 0 0 0 1\n1 0 x 0 0 0 0 1\n"),
            "t.txt:2: 'x' is not a number");
  EXPECT_EQ(TrajectoryFileRefusal("nan 0 0 0 0 0 0 1\n"), "t.txt:1: the stamp must be finite");
  EXPECT_EQ(TrajectoryFileRefusal(std::string("\xFF\xFE"
                                              "1\0 \0"
                                              "0\0\n",
                                              9)),
            "t.txt:1: holds bytes that are zero (UTF-16?), must be UTF-8 text");
  EXPECT_EQ(TrajectoryFileRefusal("1 0 0 0 0 0 0 2\n"),
            "t.txt:1: quaternion qx qy qz qw has norm 2, must be 1");
}

TEST(TrajectoryFile, RoundedQuaternionsAreNormalised) {
  const TrajectoryFile rounded = ParseTrajectory("1 0 0 0 0.7071 0 0 0.7071\n", "x");
  EXPECT_NEAR(rounded.poses[0].world_from_camera.rotation.norm(), 1.0, 1e-15);
  const TrajectoryFile exact = ParseTrajectory("1 0 0 0 0 0 0.707106781 0.707106781\n", "x");
  EXPECT_EQ(exact.poses[0].world_from_camera.rotation.w(), 0.707106781);
}

TEST(TrajectoryFile, MissingOrEmptyFile) {
  EXPECT_THROW(ReadTrajectory("/nonexistent/file.txt"), InputError);
}

}  // namespace
}  // namespace depthgrid
