#include "mapper/io/frozen_scans.h"

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

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Laser {
  double end_m = 12.0;  // the wall ahead of a corridor 2 m wide; the one behind is as far
  double sigma_m = 0.0;
  double written_m = 0.001;  // a step of the readings
};

// Half a circle of readings; 8 m and farther are none.
CarmenScan LineAt(double stamp_s, const Pose2& pose, const Laser& laser, RandomStream& random) {
  CarmenScan line;
  line.stamp_s = stamp_s;
  line.odom_from_laser = pose;
  line.first_bearing_rad = RadFromDeg(-89.5);
  line.bearing_step_rad = RadFromDeg(1.0);
  line.max_range_m = 8.0;
  for (int i = 0; i < 180; ++i) {
    const double angle_rad = pose.yaw_rad + RadFromDeg(i - 89.5);
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double x_m = ((c > 0.0 ? laser.end_m : -laser.end_m) - pose.x_m) / c;
    const double y_m = ((s > 0.0 ? 1.0 : -1.0) - pose.y_m) / s;
    const double range_m = std::min(x_m, y_m) + laser.sigma_m * random.Normal();
    line.range_m.push_back(std::min(8.0, std::round(range_m / laser.written_m) * laser.written_m));
  }
  return line;
}

// Ten scans a second of a robot that goes `step` with each; scans 20 to 39 are all the 20th.
// `corridor`: none is the 20th, but they may look so.
std::vector<CarmenScan> Drive(const Pose2& step, const Laser& laser, bool corridor = false) {
  RandomStream random(7, RandomStage::kTest);
  std::vector<CarmenScan> lines;
  Pose2 pose;
  for (int i = 0; i < 60; ++i, pose = pose * step) {
    lines.push_back(LineAt(0.1 * i, pose, laser, random));
    if (!corridor && i > 20 && i < 40) lines.back().range_m = lines[20].range_m;
  }
  return lines;
}

FrozenScans Added(const std::vector<CarmenScan>& lines) {
  FrozenScans frozen;
  for (const CarmenScan& line : lines) {
    frozen.Add(line.stamp_s, line.odom_from_laser, line.range_m, [&] { return ScanOf(line, {}); });
  }
  return frozen;
}

void ExpectFrozen(const std::vector<CarmenScan>& lines) {
  const FrozenScans frozen = Added(lines);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(frozen.frozen()[i], i > 20 && i < 40) << i;
  }
  EXPECT_EQ(frozen.count(), 19);
}

constexpr Pose2 kAhead{0.02, 0.0, 0.0};
constexpr Pose2 kTurning{0.0, 0.0, 0.01};

TEST(FrozenScans, AreThoseThatStayWhileTheRobotMoves) {
  ExpectFrozen(Drive(kTurning, {.end_m = 4.0}));
  ExpectFrozen(Drive(kAhead, {.end_m = 4.0}));  // a wall ahead comes nearer
  ExpectFrozen(Drive(kAhead, {.end_m = 4.0, .written_m = 0.01}));
  ExpectFrozen(Drive(kAhead, {.sigma_m = 0.02}));  // nothing comes nearer, but noise never stays
  ExpectFrozen(Drive(kAhead, {.sigma_m = 0.02, .written_m = 0.01}));
}

TEST(FrozenScans, WithoutReturnInPlacesAreTold) {
  std::vector<CarmenScan> lines = Drive(kAhead, {.end_m = 4.0});
  for (CarmenScan& line : lines) line.range_m[17] = std::numeric_limits<double>::quiet_NaN();
  ExpectFrozen(lines);
}

// Neither end in view, and no noise: all scans are the same.
TEST(FrozenScans, ABareCorridorLooksTheSame) {
  for (const double written_m : {0.001, 0.01, 1e-9}) {
    EXPECT_EQ(Added(Drive(kAhead, {.written_m = written_m}, true)).count(), 0) << written_m;
  }
}

TEST(FrozenScans, AreNotThoseOfARobotThatStands) {
  const Pose2 wanders{0.002, 0.001, 0.001};  // 2 cm and .6 degrees a second
  EXPECT_EQ(Added(Drive(wanders, {.end_m = 4.0})).count(), 0);
  EXPECT_EQ(Added(Drive({}, {.end_m = 4.0, .sigma_m = 0.02})).count(), 0);
}

TEST(FrozenScans, OfScansThatSeeNothingTellNothing) {
  std::vector<CarmenScan> lines = Drive(kTurning, {.end_m = 4.0});
  for (CarmenScan& line : lines) std::fill(line.range_m.begin() + 15, line.range_m.end(), 8.0);
  EXPECT_EQ(Added(lines).count(), 0);
}

// A log, of which a part is mapped: such frames have their pose alone.
TEST(FrozenScans, OfALogAreNoScans) {
  std::string log;
  for (const CarmenScan& line : Drive(kAhead, {.end_m = 4.0, .sigma_m = 0.02})) {
    log += "FLASER 180";
    for (const double range_m : line.range_m) log += fmt::format(" {:.3f}", range_m);
    log += fmt::format(" {0} 0 0 {0} 0 0 {1} host {1}\n", line.odom_from_laser.x_m,
                       10.0 + line.stamp_s);
  }
  const std::string path = ScratchPath() + ".log";
  WriteFile(path, log);
  const CarmenLog opened = OpenCarmenLog(path, {.max_range_m = 8.0}, {}, {.from_s = 1.0});
  int frames = 0;
  while (const auto frame = opened.source->Next()) {
    EXPECT_EQ(frame->scan == nullptr, frame->index > 20 && frame->index < 40) << frame->index;
    EXPECT_TRUE(frame->slam_from_camera);
    ++frames;
  }
  EXPECT_EQ(frames, 50);
  EXPECT_THAT(opened.source->Warnings(),
              ElementsAre(HasSubstr("the laser gives one scan again and again while the robot "
                                    "moves, first in frame 21: 19 frames are placed by the "
                                    "odometry alone")));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace depthgrid
