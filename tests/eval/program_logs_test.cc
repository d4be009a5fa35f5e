// Laser logs through the program: read, mapped, localised, and what is wrong with them said.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "mapper/io/map_file.h"
#include "mapper/io/trajectory_file.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using ProgramLogs = ProgramTest;

// In a room of 6 x 4 m.
double RangeM(double x_m, double y_m, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  const double along_x_m = (c > 0.0 ? 6.0 - x_m : x_m) / std::max(std::abs(c), 1e-9);
  return std::min(along_x_m, (s > 0.0 ? 4.0 - y_m : y_m) / std::max(std::abs(s), 1e-9));
}

// There and back along the room, its odometry in units of `odometry_scale` metres and on the way
// back `aside_m` to the left.
std::string ThereAndBack(double odometry_scale, double aside_m = 0.0) {
  std::string log;
  for (int i = 0; i <= 40; ++i) {
    const double x_m = 1.0 + 0.1 * (i <= 20 ? i : 40 - i);
    log += "FLASER 181";
    for (int k = 0; k <= 180; ++k)
      log += fmt::format(" {:.3f}", RangeM(x_m, 1.0, (k - 90) * kPi / 180.0));
    log += fmt::format(" {0:.3f} {1:.3f} 0 {0:.3f} {1:.3f} 0 {2} host 0\n", odometry_scale * x_m,
                       1.0 + (i > 20 ? aside_m : 0.0), i);
  }
  return log;
}

// Half round the room, by a laser whose readings are written from left to right if it is mounted
// upside down.
std::string HalfRound(bool upside_down) {
  std::string log;
  for (int i = 0; i <= 120; ++i) {
    const double at_rad = i * kPi / 120.0;
    const double x_m = 3.0 + std::sin(at_rad);
    const double y_m = 2.0 - std::cos(at_rad);
    log += "FLASER 181";
    for (int k = 0; k <= 180; ++k) {
      const int to_left_deg = upside_down ? 90 - k : k - 90;
      log += fmt::format(" {:.3f}", RangeM(x_m, y_m, at_rad + to_left_deg * kPi / 180.0));
    }
    log += fmt::format(" {0:.3f} {1:.3f} {2:.4f} {0:.3f} {1:.3f} {2:.4f} {3} host 0\n", x_m, y_m,
                       at_rad, i);
  }
  return log;
}

TEST_F(ProgramLogs, ALaserLog) {
  std::string log = "# made by hand\nPARAM laser_front_laser_resolution 1\n";
  for (int i = 0; i < 5; ++i) {
    log += "FLASER 5 2.0 2.1 2.2 2.1 2.0 0 0 0 0 0 0 " + std::to_string(i) + ".0 host 0\n";
  }
  Write("robot.log", log + "FLASER 5 2.0 2.1\n");
  const Outcome outcome = Program("map robot.log -o out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("robot.log: CARMEN laser log, 5 frames\n"));
  EXPECT_THAT(outcome.err, HasSubstr("warning: robot.log:8: FLASER with damaged readings"));
  Write("poses.txt", "0 0 0 0 0 0 0 1\n");
  EXPECT_EQ(Program("map robot.log --poses poses.txt -o out2").exit_code, 2);
}

TEST_F(ProgramLogs, ALogInTheCoordinatesOfAMapGrid) {
  std::string log;
  for (int i = 0; i < 5; ++i) {
    log += fmt::format("FLASER 5 2 2 2 2 2 {0} {1} 0 {0} {1} 0 {2} host 0\n", 400000.0 + 0.1 * i,
                       5300000.0, i);
  }
  Write("utm.log", log);
  Succeed("map utm.log -o out");
  const Eigen::Vector2d origin_m = ReadMap(Path("out/map.yaml")).map.geometry.OriginM();
  EXPECT_LT((origin_m - Eigen::Vector2d(400000.0, 5300000.0)).norm(), 5.0);
}

TEST_F(ProgramLogs, OdometryOfAnotherScaleIsSaid) {
  Write("robot.log", ThereAndBack(1.5));
  const Outcome outcome = Program("map robot.log -o out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(
      outcome.err,
      HasSubstr("robot.log: over the same stretches the given poses go 6.0 m, the map's 4."));
  EXPECT_THAT(outcome.err, HasSubstr("the odometry's scale or the laser's is wrong"));
  Write("right.log", ThereAndBack(1.0));
  EXPECT_EQ(Program("map right.log -o out2").err, "");
}

// 3 m along the room, of which the odometry says nothing.
TEST_F(ProgramLogs, OdometryThatStandsIsSaid) {
  std::string log;
  for (int i = 0; i <= 60; ++i) {
    log += "FLASER 181";
    for (int k = 0; k <= 180; ++k) {
      log += fmt::format(" {:.3f}", RangeM(1.0 + 0.05 * i, 1.0, (k - 90) * kPi / 180.0));
    }
    log += fmt::format(" 1 1 0 1 1 0 {} host 0\n", i);
  }
  Write("robot.log", log);
  EXPECT_THAT(Program("map robot.log -o out --set mapper.fusion.mode=kalman").err,
              testing::ContainsRegex(
                  "robot.log: the given poses do not move, but the map's go [23]\\.[0-9] m"));
}

TEST_F(ProgramLogs, ALaserMountedUpsideDownIsSaidAndSettled) {
  Write("robot.log", HalfRound(true));
  EXPECT_THAT(Program("map robot.log -o out").err,
              HasSubstr("robot.log: the scans turn the other way than the odometry, so the map is "
                        "mirrored: is the laser mounted upside down? --set "
                        "sequence.laser.upside_down=true\n"));
  const Outcome settled = Program("map robot.log -o out2 --set sequence.laser.upside_down=true");
  EXPECT_EQ(settled.exit_code, 0);
  EXPECT_EQ(settled.err, "");
  Write("upright.log", HalfRound(false));
  EXPECT_THAT(
      Program("map upright.log -o out3 --set sequence.laser.upside_down=true").err,
      HasSubstr("the laser not mounted upside down? --set sequence.laser.upside_down=false\n"));
}

TEST_F(ProgramLogs, ThatNothingWasMatchedIsSaid) {
  std::string log;
  for (int i = 0; i < 5; ++i) {
    log += fmt::format("FLASER 5 81 81 81 81 81 {0} 0 0 {0} 0 0 {0} host 0\n", i);
  }
  Write("open.log", log);
  const char* said = "open.log: no scan could be matched, the poses are those given";
  EXPECT_THAT(Program("map open.log -o out").err, HasSubstr(said));
  const std::string trusting = std::string("map open.log -o out2") +
                               " --set mapper.fusion.mode=fixed --set mapper.fusion.gain=0";
  EXPECT_THAT(Program(trusting).err, Not(HasSubstr(said)));
}

TEST_F(ProgramLogs, ThatFewWereMatchedIsSaid) {
  std::string log = ThereAndBack(1.0);
  for (int i = 0; i < 10; ++i) {
    log += fmt::format("FLASER 5 81 81 81 81 81 0 0 0 0 0 0 {0} host {0}\n", 1000 + i);
  }
  Write("half.log", log);
  EXPECT_THAT(Program("map half.log -o out").err,
              HasSubstr("half.log: 40 of 50 scans could be matched, the poses of the others are "
                        "those given: the others have 0 beams with a hit on average\n"));
}

// Drawn at poses that are off on the way back, its walls stand in two places.
TEST_F(ProgramLogs, AMapThatContradictsItsScansIsWarnedOf) {
  Write("robot.log", ThereAndBack(1.0, 0.5));
  const std::string trusting = " --set mapper.fusion.mode=fixed --set mapper.fusion.gain=0";
  const Outcome wrong = Program("map robot.log -o wrong" + trusting);
  EXPECT_EQ(wrong.exit_code, 0);
  EXPECT_THAT(wrong.err, HasSubstr("robot.log: the map contradicts its own scans: "));
  EXPECT_THAT(ReadFile(Path("wrong/warnings.txt")), HasSubstr("contradicts its own scans"));
  Write("right.log", ThereAndBack(1.0));
  const Outcome right = Program("map right.log -o right" + trusting);
  EXPECT_THAT(right.out, HasSubstr("\n0.0 % of the beams lead through walls of the map\n"));
  EXPECT_EQ(right.err, "");
}

// Its odometry is right; then told loops.
TEST_F(ProgramLogs, ALaserLogWithLoops) {
  Write("robot.log", ThereAndBack(1.0));
  Write("loops.txt", "0 40 0 0 0 0 0 0 1\n2 38 0.8 0 0 0 0 0 1\n3 99 0 0 0 0 0 0 1\n");
  const Outcome outcome = Program("map robot.log --loops loops.txt -o out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("2 loop closures from stamped loops\n"),
                    HasSubstr("mapped 41 of 41 frames; 1 of 2 loop closures taken\n")));
  EXPECT_THAT(outcome.err, HasSubstr("loops.txt: 1 event of frames that the recording does not"));
}

// Of 41 scans a second apart.
TEST_F(ProgramLogs, APartOfALog) {
  const std::string log = ThereAndBack(1.0);
  Write("robot.log", log);
  Write("loops.txt", "0 40 0 0 0 0 0 0 1\n12 28 0 0 0 0 0 0 1\n");
  const std::string part =
      "map robot.log --loops loops.txt --set sequence.from_s=10 --set sequence.to_s=30";
  const Outcome outcome = Program(part + " -o out");
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(
      outcome.out,
      AllOf(HasSubstr("robot.log: CARMEN laser log, 20 frames\n"),
            HasSubstr("the part of it: frames 10 to 29 of 41, 10.000 to 29.000 s of 40.000\n"),
            HasSubstr("1 loop closure with an end outside the part, left out\n"),
            HasSubstr("mapped 20 of 20 frames; 1 of 1 loop closure taken\n")));
  EXPECT_THAT(ReadFile(Path("out/frames.csv")), HasSubstr("\n10,10.000000,"));
  Succeed("map out/run.yaml -o again");
  ExpectSameBytes("out", "again");
  // The same scans as a log of their own.
  const auto line = [&](int number) {
    std::size_t at = 0;
    for (int i = 0; i < number; ++i) at = log.find('\n', at) + 1;
    return at;
  };
  Write("cut.log", log.substr(line(10), line(30) - line(10)));
  Succeed("map cut.log -o cut");
  Succeed("map robot.log -o part" + part.substr(part.find(" --set")));
  for (const char* file : {"map.pgm", "trajectory_est.txt"}) {
    EXPECT_TRUE(SameFile(std::string("cut/") + file, std::string("part/") + file)) << file;
  }
}

TEST_F(ProgramLogs, APartThatIsNotThereIsRefused) {
  Write("robot.log", ThereAndBack(1.0));
  ExpectRefusal("map robot.log -o out --set sequence.from_s=20 --set sequence.to_s=10",
                {"--set sequence.from_s=20: sequence.from_s is 20, must be below to_s, 10"});
  ExpectRefusal("map robot.log -o out --set sequence.from_s=41",
                {"depthgrid: --set sequence.from_s=41: sequence.from_s is 41, must be at most "
                 "40.000: robot.log is 40.000 s long"});
  Write("hello.log", "hello\n");
  ExpectRefusal("map hello.log -o out --set sequence.to_s=20", {"hello.log"});
  ExpectRefusal("map robot.log -o out --set sequence.to_s=50",
                {"depthgrid: --set sequence.to_s=50: sequence.to_s is 50, must be at most 41.000: "
                 "robot.log is 40.000 s long"});
}

// Odometry a quarter too long: laid over the map, its first metres say where the robot was in the
// middle of them, the first views where it began.
// Before the log is read.
TEST_F(ProgramLogs, AFinishedMapOfImpossibleSettingsIsRefused) {
  Write("robot.log", ThereAndBack(1.0));
  Succeed("map robot.log -o first");
  const std::string settings = ReadFile(Path("first/run.yaml"));
  Write("first/run.yaml", "foo: [\n");
  ExpectRefusal("map robot.log --map first -o out", {"first/run.yaml:1: not valid YAML"});
  Write("first/run.yaml", "mapper:\n  of_old: 1\n  grid: {resolution_m: -3}\n");
  ExpectRefusal("map robot.log --map first -o out",
                {"first/run.yaml:3: mapper.grid.resolution_m is '-3', must be from 0.005 to 1"});
  Write("first/run.yaml", settings + "of_old: 1\n");
  Succeed("map robot.log --map first -o out");
}

// A map_server's map, as other programs save it.
TEST_F(ProgramLogs, APictureIsNoMapToGoOnIn) {
  Write("robot.log", ThereAndBack(1.0));
  std::filesystem::create_directories(Path("maps"));
  Write("maps/floor.yaml", "image: floor.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n");
  Write("maps/floor.pgm", "P5 1 1 255 x");
  Write("maps/a.yaml", "[");  // something else
  const char* said =
      ": is a finished picture, as map_server's maps are, without the scans that it was drawn "
      "from; must be the folder of a run of depthgrid (with a run.yaml)\n";
  for (const std::string given : {"maps", "maps/floor.yaml"}) {
    ExpectRefusal("map robot.log --map " + given + " -o out",
                  {std::string("depthgrid: maps/floor.yaml") + said});
  }
  ExpectRefusal("map robot.log --map maps/floor.pgm --localise -o out", {"maps/floor.pgm", said});
  ExpectRefusal("regrid maps --resolution 0.1", {"maps/floor.yaml", said});
  std::filesystem::remove(Path("maps/floor.yaml"));
  ExpectRefusal("map robot.log --map maps -o out",
                {"maps: is no run's folder: it has no run.yaml"});
  Succeed("map robot.log -o first");
  ExpectRefusal("map robot.log --map first/map.yaml -o out",
                {"first/map.yaml: is a run's picture, must be the folder that it is in, first\n"});
  std::filesystem::remove(Path("first/run.yaml"));
  for (const std::string given : {"first", "first/map.yaml"}) {
    ExpectRefusal("map robot.log --map " + given + " -o out",
                  {"depthgrid: first/run.yaml: is missing: the folder holds a run's scans (sc"});
  }
}

TEST_F(ProgramLogs, WhereARunBeginsIsFoundWithPosesThatDrift) {
  Write("first.log", ThereAndBack(1.0));
  Succeed("map first.log -o first");
  Write("second.log", ThereAndBack(1.25));
  const Outcome outcome = Program("map second.log --map first --localise -o out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("; odometry's frame lies at ("));
  const Trajectory online = ReadTrajectory(Path("out/trajectory_online.txt"));
  ASSERT_EQ(online.size(), 41U);
  double worst_m = 0.0;
  for (std::size_t i = 0; i < online.size(); ++i) {
    const double x_m = 1.0 + 0.1 * static_cast<double>(i <= 20 ? i : 40 - i);
    const Eigen::Vector3d& at = online[i].world_from_camera.translation;
    worst_m = std::max(worst_m, std::hypot(at.x() - x_m, at.y() - 1.0));
  }
  EXPECT_LT(worst_m, 0.05);
}

// The room looks the same when it is turned by half, but somebody knows.
TEST_F(ProgramLogs, WhereARunBeginsIsSaid) {
  Write("robot.log", HalfRound(false));
  Succeed("map robot.log -o first");
  const auto begin_of = [&](const std::string& out) {
    return ReadTrajectory(Path(out + "/trajectory_est.txt")).front().world_from_camera.translation;
  };
  const Outcome outcome =
      Program("map robot.log --map first --localise --start 3.1,2.9,176 -o out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("start 3.10,2.90,176.0: the sequence begins 0.1"),
                                 HasSubstr(" degrees from there, at 3.0")));
  EXPECT_THAT(outcome.out, HasSubstr(" at the given start, elsewhere "));
  EXPECT_LT((begin_of("out") - Eigen::Vector3d(3.0, 3.0, 0.0)).norm(), 0.1);
  Succeed("map out/run.yaml -o again");
  ExpectSameBytes("out", "again");
  // Taken as it is.
  EXPECT_EQ(Program("map robot.log --map first --start 3.04,2.97,179 --start-within 0 -o as").err,
            "");
  EXPECT_THAT(ReadFile(Path("as/run.yaml")), HasSubstr("start_within_m: 0\n"));
  Succeed("map robot.log --map first --localise --start 3,1,0 -o near");
  EXPECT_LT((begin_of("near") - Eigen::Vector3d(3.0, 1.0, 0.0)).norm(), 0.1);
  const std::string wrong = Program("map robot.log --map first --start 3,2,90 -o wrong").err;
  EXPECT_THAT(wrong, HasSubstr("first: at the given start, "));
  // The map is no longer what it was.
  EXPECT_THAT(wrong, HasSubstr("wrong: if the sequence was laid onto a wrong place, this map shows "
                               "two places on top of each other ("));
  EXPECT_THAT(Program("map robot.log --map first --localise --start 3,2,90 -o as_it_was").err,
              AllOf(HasSubstr("first: at the given start, "), Not(HasSubstr("two places"))));
  // That it fits better elsewhere is said so that it can be typed.
  const std::size_t at = wrong.find("the sequence begins elsewhere (--start ");
  ASSERT_NE(at, std::string::npos) << wrong;
  const std::size_t begin = wrong.find("--start ", at);
  const std::string option = wrong.substr(begin, wrong.find(" has fit ", begin) - begin);
  Succeed("map robot.log --map first --localise " + option + " -o typed");
  const Eigen::Vector3d typed = begin_of("typed");
  EXPECT_LT(std::min((typed - Eigen::Vector3d(3.0, 1.0, 0.0)).norm(),
                     (typed - Eigen::Vector3d(3.0, 3.0, 0.0)).norm()),
            0.1);
  Succeed("map robot.log --map first --start -40,-2.5,90 -o far");  // no option of its own
}

// A key of first/map.yaml, with another value.
void SetInMap(const std::string& path, const std::string& key, const std::string& value) {
  std::string yaml = ReadFile(path);
  const std::size_t at = yaml.find(key + ":");
  yaml.replace(at, yaml.find('\n', at) - at, key + ": " + value);
  WriteFile(path, yaml);
}

TEST_F(ProgramLogs, AMapThatIsNoLongerWhatItsScansGive) {
  Write("robot.log", ThereAndBack(1.0));
  Succeed("map robot.log -o first");
  const std::string localise = "map robot.log --map first --localise --start 1,1,0 --force -o out";
  EXPECT_EQ(Program(localise).err, "");
  EXPECT_TRUE(SameFile("out/map.yaml", "first/map.yaml"));
  const std::string drawn = ReadFile(Path("out/map.yaml"));
  SetInMap(Path("first/map.yaml"), "origin", "[1, 2, 0]");
  EXPECT_THAT(Program(localise).err,
              AllOf(HasSubstr("first/map.yaml: has 1"), HasSubstr(" cells from (1.00, 2.00) on, "),
                    HasSubstr("the poses are in the frame of first/scans.bin")));
  EXPECT_TRUE(SameFile("out/map.yaml", "first/map.yaml"));
  SetInMap(Path("first/map.yaml"), "resolution", "0.1");
  EXPECT_THAT(Program(localise).err, HasSubstr("has cells of 0.1 m, they are of 0.05 m"));
  // A drive that goes on redraws it.
  Succeed("map robot.log --map first --start 1,1,0 -o more");
  EXPECT_THAT(ReadFile(Path("more/map.yaml")), HasSubstr("resolution: 0.05"));
  SetInMap(Path("first/map.yaml"), "image", "floor.pgm");
  std::filesystem::rename(Path("first/map.pgm"), Path("first/floor.pgm"));
  EXPECT_THAT(Program(localise).err,
              HasSubstr("first/map.yaml: image is floor.pgm, must be map.pgm or map.scale.png to "
                        "be kept: the map handed on is drawn from its scans\n"));
  EXPECT_TRUE(ReadFile(Path("out/map.yaml")) == drawn);
  EXPECT_TRUE(SameFile("out/map.pgm", "first/floor.pgm"));
  std::filesystem::remove(Path("first/map.yaml"));
  EXPECT_THAT(Program(localise).err, HasSubstr("first/map.yaml: no such file: the map handed on"));
  EXPECT_TRUE(ReadFile(Path("out/map.yaml")) == drawn);
}

TEST_F(ProgramLogs, ARunIsAnotherOneInAMapThatWasMadeAgain) {
  Write("robot.log", ThereAndBack(1.0));
  Succeed("map robot.log -o first");
  Succeed("map robot.log --map first --start 1,1,0 -o out");
  EXPECT_EQ(Program("map out/run.yaml -o same").err, "");
  Succeed("map robot.log -o first --force --set sequence.to_s=30");
  EXPECT_THAT(Program("map out/run.yaml -o other").err,
              AllOf(HasSubstr("warning: out/run.yaml: map_hash is "), HasSubstr("first is "),
                    HasSubstr(" now: this run differs from the recorded one\n")));
  EXPECT_EQ(Program("map out/run.yaml --map first -o chosen").err, "");
}

// Its wheels are counted from zero again in the middle.
TEST_F(ProgramLogs, OdometryThatBeginsAnewIsOfNoOtherScale) {
  std::string log;
  for (int i = 0; i <= 80; ++i) {
    const double x_m = 1.0 + 0.05 * i;
    log += "FLASER 181";
    for (int k = 0; k <= 180; ++k) {
      log += fmt::format(" {:.3f}", RangeM(x_m, 1.0, (k - 90) * kPi / 180.0));
    }
    const double odometry_m = i < 70 ? x_m : x_m - 4.5;
    log += fmt::format(" {0:.3f} 0 0 {0:.3f} 0 0 {1:.1f} host 0\n", odometry_m, 0.1 * i);
  }
  Write("robot.log", log);
  EXPECT_THAT(Program("map robot.log -o out").err, Not(HasSubstr("over the same stretches")));
}

}  // namespace
}  // namespace depthgrid
