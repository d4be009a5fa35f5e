#include "mapper/io/own_body.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "mapper/core/angle.h"
#include "mapper/core/rng.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/file.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// 180 readings of half a circle in a box of `half` = (x, y) about the origin, to the millimetre.
CarmenScan LineAt(const Pose2& pose, const Eigen::Vector2d& half, RandomStream& random) {
  CarmenScan line;
  line.odom_from_laser = pose;
  line.first_bearing_rad = RadFromDeg(-89.5);
  line.bearing_step_rad = RadFromDeg(1.0);
  for (int i = 0; i < 180; ++i) {
    const double angle_rad = pose.yaw_rad + RadFromDeg(i - 89.5);
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double x_m = ((c > 0.0 ? half.x() : -half.x()) - pose.x_m) / c;
    const double y_m = ((s > 0.0 ? half.y() : -half.y()) - pose.y_m) / s;
    const double range_m = std::min(x_m, y_m) + 0.01 * random.Normal();
    line.range_m.push_back(std::round(range_m * 1e3) * 1e-3);
  }
  return line;
}

// A turn on the spot, nearly so far, and a little farther with each scan.
std::vector<CarmenScan> Turn(double turn_rad, const Eigen::Vector2d& half = {3.0, 2.0}) {
  RandomStream random(7, RandomStage::kTest);
  std::vector<CarmenScan> lines;
  for (double yaw_rad = 0.0; yaw_rad < turn_rad; yaw_rad += 0.05) {
    lines.push_back(LineAt({0.0, 0.0, WrapAngle(yaw_rad)}, half, random));
  }
  return lines;
}

// A post that readings 40 to 49 show, or none from there on.
void AddPost(double range_m, std::vector<CarmenScan>& lines) {
  RandomStream random(8, RandomStage::kTest);
  for (CarmenScan& line : lines) {
    for (std::size_t i = 40; i < 50; ++i) line.range_m[i] = range_m + 0.005 * random.Normal();
  }
}

OwnBody OwnBodyOf(const std::vector<CarmenScan>& lines) {
  OwnBody body;
  for (const CarmenScan& line : lines) body.Add(line, 0.1);
  body.Find();
  return body;
}

TEST(OwnBody, IsWhatStaysWhileTheRobotTurns) {
  for (const double range_m : {0.15, 0.3, 0.9}) {
    std::vector<CarmenScan> lines = Turn(kPi + 0.2);
    AddPost(range_m, lines);
    const OwnBody body = OwnBodyOf(lines);
    ASSERT_EQ(body.parts().size(), 1U) << range_m;
    const OwnBody::Part& part = body.parts()[0];
    EXPECT_EQ(part.first, 40U);
    EXPECT_EQ(part.last, 49U);
    EXPECT_NEAR(part.range_m, range_m, 0.005);
  }
}

// What is behind it, where it wobbles, and what is beside it stays; its edge goes.
TEST(OwnBody, AloneIsDropped) {
  std::vector<CarmenScan> lines = Turn(kPi + 0.2);
  AddPost(0.3, lines);
  CarmenScan line = lines[5];
  line.range_m[39] = 0.31;
  line.range_m[45] = 2.0;
  line.range_m[60] = 0.3;
  line.range_m[41] = std::numeric_limits<double>::quiet_NaN();
  const CarmenScan before = line;
  OwnBodyOf(lines).Drop(line);
  for (std::size_t i = 0; i < line.range_m.size(); ++i) {
    if (i == 41) continue;
    const bool is_body = i >= 39 && i < 50 && i != 45;
    EXPECT_EQ(line.range_m[i], is_body ? 0.0 : before.range_m[i]) << i;
  }
  CarmenScan other = before;
  other.range_m.push_back(1.0);
  OwnBodyOf(lines).Drop(other);
  EXPECT_EQ(other.range_m[39], 0.31);  // of a laser with another count of readings
}

TEST(OwnBody, MayBeMissedNowAndThen) {
  std::vector<CarmenScan> lines = Turn(8.0 * kPi);
  AddPost(0.3, lines);
  for (std::size_t i = 10; i < lines.size(); i += 30) lines[i].range_m[44] = 1.5;
  EXPECT_EQ(OwnBodyOf(lines).parts().size(), 1U);
  for (std::size_t i = 10; i < lines.size(); i += 2) lines[i].range_m[44] = 1.5;
  EXPECT_EQ(OwnBodyOf(lines).parts().size(), 1U);
  CarmenScan line = lines[11];
  OwnBodyOf(lines).Drop(line);
  EXPECT_EQ(line.range_m[44], 0.0);
}

TEST(OwnBody, NeedsHalfATurnAndIsNear) {
  std::vector<CarmenScan> lines = Turn(0.8 * kPi);
  AddPost(0.3, lines);
  EXPECT_THAT(OwnBodyOf(lines).parts(), IsEmpty());
  lines = Turn(4.0 * kPi);
  AddPost(1.2, lines);
  EXPECT_THAT(OwnBodyOf(lines).parts(), IsEmpty());
  EXPECT_THAT(OwnBodyOf({}).parts(), IsEmpty());
}

// Whatever the way is wide: in the middle of a small room, along a wall and round its corners.
TEST(OwnBody, IsNoWall) {
  EXPECT_THAT(OwnBodyOf(Turn(8.0 * kPi, {0.7, 0.7})).parts(), IsEmpty());
  RandomStream random(7, RandomStage::kTest);
  std::vector<CarmenScan> lines;
  for (int lap = 0; lap < 4; ++lap) {
    const double ways_m[] = {7.0, 3.0, 7.0, 3.0};
    Pose2 pose{-3.5, -1.5, 0.0};  // 0.5 m from a wall to the right
    for (const double way_m : ways_m) {
      for (double at_m = 0.0; at_m < way_m; at_m += 0.1) {
        lines.push_back(LineAt(pose * Pose2{at_m, 0.0, 0.0}, {4.0, 2.0}, random));
      }
      pose = pose * Pose2{way_m, 0.0, 0.0};
      for (int i = 0; i < 10; ++i) {
        lines.push_back(LineAt(pose, {4.0, 2.0}, random));
        pose = pose * Pose2{0.0, 0.0, 0.05 * kPi};
      }
    }
  }
  EXPECT_THAT(OwnBodyOf(lines).parts(), IsEmpty());
}

std::string LogOf(const std::vector<CarmenScan>& lines) {
  std::string log;
  double stamp_s = 10.0;
  for (const CarmenScan& line : lines) {
    log += "FLASER 180";
    for (const double range_m : line.range_m) log += fmt::format(" {:.3f}", range_m);
    log += fmt::format(" 0 0 {0} 0 0 {0} {1} host {1}\n", line.odom_from_laser.yaw_rad, stamp_s);
    stamp_s += 0.1;
  }
  return log;
}

TEST(OwnBody, OfALogIsNoData) {
  std::vector<CarmenScan> lines = Turn(kPi + 0.2);
  AddPost(0.3, lines);
  const std::string path = ScratchPath() + ".log";
  WriteFile(path, LogOf(lines));
  const auto source = OpenCarmenLog(path);
  while (const auto frame = source->Next()) {
    for (std::size_t i = 40; i < 50; ++i) {
      EXPECT_FALSE(frame->scan->beams[i].hit);
      EXPECT_EQ(frame->scan->beams[i].clear_to_m, 0.0F);
    }
    EXPECT_TRUE(frame->scan->beams[70].hit);
  }
  EXPECT_THAT(source->Warnings(),
              ElementsAre(HasSubstr("readings stay the same while the robot turns (0.30 m from "
                                    "-50 to -41 degrees): taken for parts of the robot and left "
                                    "out (sequence.laser.drop_body=false keeps them)")));
  const auto whole = OpenCarmenLog(path, {.drop_body = false});
  EXPECT_TRUE(whole->Next()->scan->beams[45].hit);
  EXPECT_THAT(whole->Warnings(), IsEmpty());
  EXPECT_THAT(OpenCarmenLog(path, {.fov_deg = 358.0, .upside_down = true})->Warnings(),
              Contains(HasSubstr("(0.30 m from 99 to 81 degrees)")));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace depthgrid
