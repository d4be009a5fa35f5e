// Laser logs that state the poses of a robot on which the laser is mounted off and turned.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "mapper/core/pose2.h"
#include "mapper/io/map_file.h"
#include "mapper/io/trajectory_file.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kScans = 160;
constexpr const char* kMounted =
    " --set sequence.laser.mount.x_m=0.3 --set sequence.laser.mount.y_m=0.1 --set "
    "sequence.laser.mount.yaw_deg=45";
const Pose2 kMount = {0.3, 0.1, RadFromDeg(45.0)};

// Along a figure of eight in a room of 6 x 4 m.
Pose2 RobotAt(int scan) {
  const double at_rad = 2.0 * kPi * scan / kScans;
  return {3.0 + 1.5 * std::sin(at_rad), 2.0 + 0.7 * std::sin(2.0 * at_rad),
          std::atan2(1.4 * std::cos(2.0 * at_rad), 1.5 * std::cos(at_rad))};
}

double RangeM(const Pose2& from, double bearing_rad) {
  const double c = std::cos(from.yaw_rad + bearing_rad);
  const double s = std::sin(from.yaw_rad + bearing_rad);
  const double along_x_m = (c > 0.0 ? 6.0 - from.x_m : from.x_m) / std::max(std::abs(c), 1e-9);
  const double along_y_m = (s > 0.0 ? 4.0 - from.y_m : from.y_m) / std::max(std::abs(s), 1e-9);
  return std::min(along_x_m, along_y_m);
}

class ProgramMount : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Write("robot.log", Log({}));
    Write("laser.log", Log(kMount));
  }

  // Of a laser at kMount; poses of the point at `stated`.
  static std::string Log(const Pose2& stated) {
    std::string log;
    for (int i = 0; i < kScans; ++i) {
      const Pose2 laser = RobotAt(i) * kMount;
      log += "FLASER 181";
      for (int k = 0; k <= 180; ++k)
        log += fmt::format(" {:.3f}", RangeM(laser, (k - 90) * kPi / 180.0));
      const Pose2 pose = RobotAt(i) * stated;
      log += fmt::format(" {0:.6f} {1:.6f} {2:.6f} {0:.6f} {1:.6f} {2:.6f} {3:.1f} host 0\n",
                         pose.x_m, pose.y_m, pose.yaw_rad, 0.5 * i);
    }
    return log;
  }
  // Of poses that should be the robot's.
  double WorstErrorM(const std::string& trajectory) const {
    const Trajectory poses = ReadTrajectory(Path(trajectory));
    EXPECT_EQ(poses.size(), static_cast<std::size_t>(kScans));
    double worst_m = 0.0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Pose2 robot = RobotAt(static_cast<int>(i));
      const Eigen::Vector3d& at = poses[i].world_from_camera.translation;
      worst_m = std::max(worst_m, (at.head<2>() - robot.translation()).norm());
    }
    return worst_m;
  }
  // Of the walls of the one map, which share the other has no wall of.
  double MissingWalls(const std::string& map, const std::string& other) const {
    const StateMap a = StatesOf(ReadMap(Path(map)).map);
    const StateMap b = StatesOf(ReadMap(Path(other)).map);
    int walls = 0, missing = 0;
    const GridGeometry& g = a.geometry;
    for (int j = 0; j < g.height_cells; ++j) {
      for (int i = 0; i < g.width_cells; ++i) {
        const Cell cell = {g.min_cell.x + i, g.min_cell.y + j};
        if (a.At(cell) != CellState::kOccupied) continue;
        ++walls;
        missing += b.At(cell) == CellState::kOccupied ? 0 : 1;
      }
    }
    EXPECT_GT(walls, 300);
    return static_cast<double>(missing) / walls;
  }
};

TEST_F(ProgramMount, IsSaidWithTheSettingAndSettled) {
  EXPECT_EQ(Program("map laser.log -o laser").err, "");
  EXPECT_THAT(
      Program("map robot.log -o without").err,
      AllOf(ContainsRegex("robot.log: the laser sits 0\\.(29|30|31) m ahead, 0\\.(09|10|11) m to "
                          "the left and looks 4[456] degrees to the left of the given poses, "
                          "throughout: if they are the robot's, --set "
                          "sequence.laser.mount.x_m=0\\.(29|30|31) --set "
                          "sequence.laser.mount.y_m=0\\.(09|10|11) --set "
                          "sequence.laser.mount.yaw_deg=4[456] says where on it the laser is; or "),
            Not(HasSubstr("where the odometry turns"))));
  EXPECT_GT(MissingWalls("laser/map.yaml", "without/map.yaml"), 0.5);
  EXPECT_EQ(Program(std::string("map robot.log -o mounted") + kMounted).err, "");
  EXPECT_LT(MissingWalls("laser/map.yaml", "mounted/map.yaml"), 0.02);
  EXPECT_LT(MissingWalls("mounted/map.yaml", "laser/map.yaml"), 0.02);
  // Poses come out of what they came in of.
  for (const char* name : {"est", "online", "slam"}) {
    EXPECT_LT(WorstErrorM(fmt::format("mounted/trajectory_{}.txt", name)), 0.02) << name;
  }
  // The page lays the hits of each scan at such a pose.
  const double range_m = RangeM(RobotAt(0) * kMount, -0.5 * kPi);
  const Eigen::Vector2d hit = kMount * Eigen::Vector2d(0.0, -range_m);
  EXPECT_THAT(ReadFile(Path("mounted/report.html")),
              HasSubstr(fmt::format("\"scans\":[{{\"row\":0,\"cm\":[{},{},",
                                    std::lround(100.0 * hit.x()), std::lround(100.0 * hit.y()))));
  EXPECT_THAT(ReadFile(Path("mounted/run.yaml")), HasSubstr("yaw_deg: 45\n"));
  Succeed("map mounted/run.yaml -o again");
  ExpectSameBytes("mounted", "again");
}

// What is told is to be set, not to be added.
TEST_F(ProgramMount, AWrongOneIsSaidWithTheRightOne) {
  EXPECT_THAT(Program("map robot.log -o out --set sequence.laser.mount.x_m=0.3 --set "
                      "sequence.laser.mount.yaw_deg=-45")
                  .err,
              AllOf(ContainsRegex("looks (89|90|91) degrees to the left of where "
                                  "sequence.laser.mount has it, throughout"),
                    ContainsRegex("mount.x_m=0\\.(29|30|31) --set sequence.laser.mount.y_m=0\\.("
                                  "09|10|11) --set sequence.laser.mount.yaw_deg=4[456] ")));
}

TEST_F(ProgramMount, AStartIsTheRobotsPose) {
  Succeed("map laser.log -o first");
  const Outcome outcome = Program(std::string("map robot.log --map first --localise --start ") +
                                  fmt::format("3,2,{:.3f}", DegFromRad(RobotAt(0).yaw_rad)) +
                                  " --start-within 0 -o out" + kMounted);
  EXPECT_EQ(outcome.err, "");
  EXPECT_LT(WorstErrorM("out/trajectory_est.txt"), 0.03);
}

TEST_F(ProgramMount, BadValuesAreRefused) {
  const std::string map = "map robot.log -o out --set sequence.laser.mount.";
  ExpectRefusal(map + "x_m=300", {"mount.x_m is '300', must be from -10 to 10"});
  ExpectRefusal(map + "y_m=nan", {"mount.y_m is 'nan', must be a number"});
  ExpectRefusal(map + "yaw_deg=400", {"mount.yaw_deg is '400', must be from -360 to 360"});
  ExpectRefusal("map robot.log -o out --set sequence.laser.mount=[0.3,0.1]",
                {"sequence.laser.mount", "must be"});
}

}  // namespace
}  // namespace depthgrid
