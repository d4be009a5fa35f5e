#include "mapper/io/trajectory_columns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/io/pose_file.h"
#include "mapper/io/trajectory_file.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Its quaternion is w .5, x .1, y .7, z .5 in all files here.
void ExpectThePose(const TrajectoryFile& file, const std::vector<double>& stamps_s) {
  ASSERT_EQ(file.poses.size(), stamps_s.size());
  for (std::size_t i = 0; i < stamps_s.size(); ++i) {
    const auto& [stamp_s, pose] = file.poses[i];
    EXPECT_NEAR(stamp_s, stamps_s[i], 5e-7);
    EXPECT_EQ(pose.translation, Eigen::Vector3d(1.0, 2.0, 3.0));
    EXPECT_TRUE(pose.rotation.isApprox(Eigen::Quaterniond(0.5, 0.1, 0.7, 0.5))) << i;
  }
}

TrajectoryFile Parsed(const std::string& text) { return ParseTrajectory(text, "t"); }
std::string Refused(const std::string& text) {
  return RefusalOf([&] { Parsed(text); });
}

constexpr const char* kEurocNames =
    "p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
    "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], b_w_RS_S_y "
    "[rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m "
    "s^-2]\r\n";
constexpr const char* kEurocRow = ",1,2,3,.5,.1,.7,.5,.1,.2,.3,0,0,0,0,0,0\r\n";
const std::string kEuroc =
    "1403636580838555648" + std::string(kEurocRow) + "1403636580843555648" + kEurocRow;

TEST(TrajectoryColumns, EurocsGroundTruth) {
  const std::vector<double> stamps_s = {1403636580.838556, 1403636580.843556};
  const TrajectoryFile stated = Parsed("#timestamp [ns]," + std::string(kEurocNames) + kEuroc);
  ExpectThePose(stated, stamps_s);
  EXPECT_THAT(stated.Warnings("t"), ElementsAre());
  // Of two of its recordings the header names no unit; and without any header.
  const TrajectoryFile unstated = Parsed("#timestamp, " + std::string(kEurocNames) + kEuroc);
  ExpectThePose(unstated, stamps_s);
  EXPECT_THAT(unstated.Warnings("t"), ElementsAre(HasSubstr("t: line 1 names no unit")));
  const TrajectoryFile bare = Parsed(kEuroc);
  ExpectThePose(bare, stamps_s);
  EXPECT_THAT(bare.Warnings("t"), ElementsAre(HasSubstr("nanoseconds x y z qw qx qy qz")));
}

TEST(TrajectoryColumns, OfVins) {
  // Its odometry and its pose graph; the clock of a simulation begins at 0.
  const TrajectoryFile odometry = Parsed(
      "33333333,1,2,3,.5,.1,.7,.5,.1,.2,.3,\n33333333,1,2,3,.5,.1,.7,.5,.1,.2,.3,\n"
      "66666667,1,2,3,.5,.1,.7,.5,.1,.2,.3,\n");
  ExpectThePose(odometry, {0.033333, 0.066667});
  EXPECT_THAT(odometry.Warnings("t"),
              ElementsAre("t: no header names its columns; read as VINS and EuRoC write them, "
                          "nanoseconds x y z qw qx qy qz (a first line #timestamp "
                          "[ns],x,y,z,qx,qy,qz,qw, and so on, names others)",
                          HasSubstr("1 row with a stamp already given")));
  ExpectThePose(Parsed("1403636580838555648,1,2,3,.5,.1,.7,.5,\n"), {1403636580.838556});
}

// Commas alone make no other order.
TEST(TrajectoryColumns, OfSecondsWithCommasAreTums) {
  const TrajectoryFile file =
      Parsed("1700000000,1,2,3,.1,.7,.5,.5\n1700000001,1,2,3,.1,.7,.5,.5\n");
  ExpectThePose(file, {1700000000.0, 1700000001.0});
  EXPECT_THAT(file.Warnings("t"), ElementsAre());
  EXPECT_THAT(Refused("1403636580838555648 1 2 3 .1 .7 .5 .5\n"), HasSubstr("must be in seconds"));
  EXPECT_THAT(Refused("1403636580838,1,2,3,.1,.7,.5,.5\n1403636581838,1,2,3,.1,.7,.5,.5\n"),
              HasSubstr("must be in seconds"));
  // Keyframes a second apart in microseconds.
  EXPECT_THAT(Refused("1403636580838555,1,2,3,.1,.7,.5,.5\n1403636581838555,1,2,3,.1,.7,.5,.5\n"),
              HasSubstr("must be in seconds"));
}

TEST(TrajectoryColumns, AHeaderNamesThem) {
  const std::vector<double> stamps_s = {1.5};
  // RTAB-Map with ids.
  ExpectThePose(Parsed("#timestamp x y z qx qy qz qw id\n1.5 1 2 3 .1 .7 .5 .5 7\n"), stamps_s);
  // A table of a program of one's own: no comment, other order, quotes, further columns.
  ExpectThePose(Parsed("\"id\",\"qw\",\"qx\",\"qy\",\"qz\",\"tx\",\"ty\",\"tz\",\"time_ms\"\n"
                       "7,.5,.1,.7,.5,1,2,3,1500\n"),
                stamps_s);
  ExpectThePose(
      Parsed("# made by hand\n# Time [s] v [m s^-1] pos_x [m] pos_y [m] pos_z [m] quat_w quat_x "
             "quat_y quat_z\n1.5 9 1 2 3 .5 .1 .7 .5\n"),
      stamps_s);
  ExpectThePose(Parsed("#timestamp [us],p.x,p.y,p.z,orientation.x,orientation.y,orientation.z,"
                       "orientation.w\n1500000,1,2,3,.1,.7,.5,.5\n"),
                stamps_s);
  // An index without a name, and a comma at each line's end.
  ExpectThePose(Parsed(",t,x,y,z,qx,qy,qz,qw,\n0,1.5,1,2,3,.1,.7,.5,.5,\n"), stamps_s);
  // One that names less, or one twice, is a comment.
  ExpectThePose(Parsed("# t x y z qx qy qz qw tx\n1.5 1 2 3 .1 .7 .5 .5\n"), stamps_s);
  ExpectThePose(Parsed("# stamp x y z w x y z\n1.5 1 2 3 .1 .7 .5 .5\n"), stamps_s);
  ExpectThePose(Parsed("1.5 1 2 3 .1 .7 .5 .5\n# t x y z qw qx qy qz\n"), stamps_s);
}

TEST(TrajectoryColumns, OfMatricesHaveNoNames) {
  const std::string twelve = "1.5 1 2 3 .1 .7 .5 .5 0 0 0 0\n";
  EXPECT_TRUE(HoldsMatrices(twelve));
  EXPECT_FALSE(HoldsMatrices("# t x y z qx qy qz qw a b c d\n" + twelve));
}

TEST(TrajectoryColumns, OneClearLineForEachFault) {
  const std::string stated = "#timestamp [ns]," + std::string(kEurocNames);
  EXPECT_EQ(Refused("1 1 2 3 .1 .7 .5 .5 7\n"),
            "t:1: has 9 columns, must have 8, stamp x y z qx qy qz qw, or a header line before it "
            "that names all of them");
  EXPECT_EQ(Refused(stated + "1403636580838555648,1,2,3,.5,.1,.7\n"),
            "t:2: has 7 columns, must have 17");
  EXPECT_EQ(Refused(stated + "1403636580838555648,1,2,3,.5,.1,.7,.x,.1,.2,.3,0,0,0,0,0,0\n"),
            "t:2: '.x' is not a number");
  EXPECT_EQ(Refused(stated + "1403636580838555648,1,2,3,.9,.9,.7,.5,.1,.2,.3,0,0,0,0,0,0\n"),
            "t:2: quaternion qx qy qz qw has norm 1.53623, must be 1");
  EXPECT_EQ(Refused("#timestamp x y z qx qy qz qw id\n1.5 1 2 3 .1 .7 .5 .5\n"),
            "t:2: has 8 columns, must have 9");
  EXPECT_THAT(Refused("#timestamp [s] x y z qx qy qz qw\n1403636580838555648 1 2 3 .1 .7 .5 .5\n"),
              HasSubstr("t:2: the stamp is 1.40364e+18, must be in seconds"));
  std::string wide;  // as a Windows shell writes it
  for (const char c : "1 1 2 3 .1 .7 .5 .5 7\n1 1 2 3 .1 .7 .5 .5 7\n") wide += {c, '\0'};
  EXPECT_THAT(Refused(wide), HasSubstr("t:1: holds bytes that are zero"));
  EXPECT_EQ(Refused("33333333;1;2;3;.5;.1;.7;.5\n66666667;1;2;3;.5;.1;.7;.5\n"),
            "t:1: has semicolons between its columns, must have spaces or commas");
}

}  // namespace
}  // namespace depthgrid
