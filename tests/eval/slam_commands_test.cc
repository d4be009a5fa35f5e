// `slam`, `slam-fit` and `slam-calibrate` as a user types them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/io/trajectory_file.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SlamCommands : public ProgramTest {
 protected:
  // A folder as a recording has it, without any image: 40 s along a line and back.
  void WriteSequence(const std::string& name, int frames = 1200) const {
    std::filesystem::create_directories(Path(name + "/depth"));
    std::string images = "# depth\n";
    std::string truth = "# truth\n";
    for (int i = 0; i < frames; ++i) {
      const double stamp_s = i / 30.0;
      const int way = i < frames / 2 ? i : frames - 1 - i;
      images += std::to_string(stamp_s) + " depth/" + std::to_string(i) + ".png\n";
      truth += std::to_string(stamp_s) + " " + std::to_string(0.005 * way) +
               " 0 1.1 -0.5 0.5 -0.5 0.5\n";
    }
    Write(name + "/depth.txt", images);
    Write(name + "/groundtruth.txt", truth);
  }
};

TEST_F(SlamCommands, SlamWritesLiveFinalAndLoops) {
  WriteSequence("seq");
  Succeed("slam seq --profile orb_slam2 --seed 4 -o one");
  EXPECT_THAT(FilesIn("one"), ElementsAre("loops.csv", "slam.txt", "slam.yaml", "slam_final.txt"));
  EXPECT_EQ(ReadTrajectory(Path("one/slam.txt")).size(), 1200U);
  Succeed("slam seq --profile orb_slam2 --seed 4 -o again");
  Succeed("slam seq --profile orb_slam2 --seed 5 -o other");
  for (const char* file : {"/slam.txt", "/slam_final.txt", "/loops.csv", "/slam.yaml"}) {
    EXPECT_TRUE(SameFile(std::string("one") + file, std::string("again") + file)) << file;
  }
  EXPECT_FALSE(SameFile("one/slam.txt", "other/slam.txt"));
  // Coming back over the old way closes a loop, which the final trajectory knows from the start.
  EXPECT_THAT(ReadFile(Path("one/loops.csv")), HasSubstr("\n"));
  EXPECT_FALSE(SameFile("one/slam.txt", "one/slam_final.txt"));
  Succeed("slam seq --profile orb_slam2 --seed 4 --set slam.loops.scenario=none -o open");
  EXPECT_TRUE(SameFile("open/slam.txt", "open/slam_final.txt"));
}

TEST_F(SlamCommands, SlamOfTheTruthIsTheTruth) {
  WriteSequence("seq", 60);
  Succeed("slam seq --profile ground_truth -o out");
  const Trajectory truth = ReadTrajectory(Path("seq/groundtruth.txt"));
  const Trajectory live = ReadTrajectory(Path("out/slam.txt"));
  ASSERT_EQ(live.size(), truth.size());
  for (std::size_t i = 0; i < live.size(); ++i) {
    EXPECT_EQ(live[i].world_from_camera, truth[i].world_from_camera);
  }
}

TEST_F(SlamCommands, AGainOfNothingGivesItsFilesBack) {
  Succeed("render ./small.yaml --no-colour -o seq");
  Succeed("slam seq --profile orb_slam2 --seed 1 -o slam");
  Succeed("run ./small.yaml --set mapper.fusion.gain=0 -o out");
  EXPECT_TRUE(SameFile("slam/slam.txt", "out/trajectory_slam.txt"));
  EXPECT_TRUE(SameFile("slam/slam.txt", "out/trajectory_online.txt"));
  EXPECT_TRUE(SameFile("slam/slam_final.txt", "out/trajectory_est.txt"));
  EXPECT_FALSE(SameFile("slam/slam.txt", "out/trajectory_truth.txt"));
}

TEST_F(SlamCommands, SlamRefusesBadInput) {
  WriteSequence("seq", 30);
  ExpectRefusal("slam nowhere -o out", {"nowhere"});
  ExpectRefusal("slam seq --profile orb_slam -o out", {"'orb_slam2'"});
  ExpectRefusal("slam seq --set slam.drift_scael=2 -o out", {"'slam.drift_scale'"});
  ExpectRefusal("slam seq --set slam.loops.precision=0 -o out", {"slam.loops.precision"});
  ExpectRefusal("slam seq", {"--output"});
  Write("seq/groundtruth.txt", "100 0 0 1 -0.5 0.5 -0.5 0.5\n");
  ExpectRefusal("slam seq -o out", {"groundtruth.txt"});
}

TEST_F(SlamCommands, RowsOfTheTruthThatAreLeftOutAreSaid) {
  WriteSequence("seq", 60);
  const std::string truth = ReadFile(Path("seq/groundtruth.txt"));
  const std::string last = truth.substr(truth.rfind('\n', truth.size() - 2) + 1);
  Write("seq/groundtruth.txt", truth + last);
  Succeed("slam seq -o slam");
  for (const char* command : {"slam seq -o again", "slam-fit seq/groundtruth.txt slam/slam.txt"}) {
    EXPECT_THAT(Program(command).err,
                HasSubstr("seq/groundtruth.txt: 1 row with a stamp already given, ignored"));
  }
}

TEST_F(SlamCommands, FitFindsWhatSlamDid) {
  WriteSequence("seq");
  Succeed(
      "slam seq --profile ground_truth --set slam.jitter_translation_m=0.004 "
      "--set slam.jitter_rotation_deg=0.1 -o out");
  const Outcome fit = Program("slam-fit seq/groundtruth.txt out/slam.txt");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  const auto value = [&](const std::string& key) {
    const auto at = fit.out.find("\n  " + key + ": ");
    EXPECT_NE(at, std::string::npos) << key << "\n" << fit.out;
    return at == std::string::npos ? -1.0 : std::stod(fit.out.substr(at + key.size() + 5));
  };
  EXPECT_NEAR(value("jitter_translation_m"), 0.004, 0.0004);
  EXPECT_NEAR(value("jitter_rotation_deg"), 0.1, 0.015);
  EXPECT_NEAR(value("walk_translation_m"), 0.0, 0.001);
  EXPECT_EQ(fit.err.find("badly"), std::string::npos) << fit.err;
  // It can be put into an experiment as it stands.
  Write("fitted.yaml", "scene: ./room.yaml\n" + fit.out);
  EXPECT_EQ(Program("run ./fitted.yaml -o fitted --set frames=2 --set sensor.width=80 --set "
                    "sensor.height=60")
                .exit_code,
            0);
}

// Errors that swing once a second, which no walk, bias or drift does.
TEST_F(SlamCommands, FitSaysWhereItImitatesARunBadly) {
  std::string truth, swinging;
  for (int i = 0; i < 1800; ++i) {
    const double stamp_s = i / 30.0, x_m = 0.3 * stamp_s, y_m = std::sin(0.2 * stamp_s);
    const double off_m = 0.05 * std::sin(RadFromDeg(360.0) * stamp_s) + 0.001 * (i % 3);
    const char* pose = "{:.6f} {:.6f} {:.6f} 1 -0.5 0.5 -0.5 0.5\n";
    truth += fmt::format(fmt::runtime(pose), stamp_s, x_m, y_m);
    swinging += fmt::format(fmt::runtime(pose), stamp_s, x_m + off_m, y_m);
  }
  Write("truth.txt", truth);
  Write("swinging.txt", swinging);
  const Outcome fit = Program("slam-fit truth.txt swinging.txt");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_THAT(fit.err, HasSubstr("swinging.txt: the settings below imitate this run badly: over "));
}

// Nothing errs, no loop is closed: neither does what imitates it.
TEST_F(SlamCommands, FitOfATruthWithItselfErrsNowhere) {
  WriteSequence("seq");
  const Outcome fit = Program("slam-fit seq/groundtruth.txt seq/groundtruth.txt");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_THAT(fit.err, HasSubstr("groundtruth.txt: there are no errors to fit"));
  EXPECT_THAT(fit.out, HasSubstr("scenario: none\n"));
  std::istringstream lines(fit.out);
  int lags = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream row(line);
    std::string mark, unit;
    double lag_s, run_mm, surrogate_mm, run_deg, surrogate_deg;
    row >> mark >> lag_s >> unit >> run_mm >> surrogate_mm >> run_deg >> surrogate_deg;
    if (!row || mark != "#" || unit != "s") continue;
    EXPECT_EQ(surrogate_mm, 0.0) << line;
    EXPECT_EQ(surrogate_deg, 0.0) << line;
    ++lags;
  }
  EXPECT_GE(lags, 4);
  EXPECT_THAT(fit.out, HasSubstr("none is closed, as there is no correction\n"));
}

// Coming back over the old way closes a loop, which shows in the poses.
TEST_F(SlamCommands, FitOfCorrectedPosesClosesLoops) {
  WriteSequence("seq");
  Succeed("slam seq --profile orb_slam2 --seed 4 -o out");
  const Outcome fit = Program("slam-fit seq/groundtruth.txt out/slam.txt");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_EQ(fit.out.find(" 0 corrections"), std::string::npos) << fit.out;
  EXPECT_THAT(fit.out, HasSubstr("every revisit is closed, as there are corrections\n"));
  EXPECT_THAT(fit.out, HasSubstr("scenario: true\n"));
}

TEST_F(SlamCommands, FitRefusesBadInput) {
  WriteSequence("seq", 30);
  ExpectRefusal("slam-fit seq/groundtruth.txt", {"--help"});
  Write("short.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  ExpectRefusal("slam-fit short.txt short.txt",
                {"short.txt: 2 poses have both truth and estimate, must be at least 100"});
  ExpectRefusal("slam-fit seq/groundtruth.txt nothing.txt", {"nothing.txt"});
  ExpectRefusal("slam-fit seq/groundtruth.txt seq/groundtruth.txt seq/groundtruth.txt", {"pairs"});
  Write("later.txt", "1000 0 0 0 0 0 0 1\n");
  const std::string truth_path = "seq/groundtruth.txt";
  const Trajectory truth = ReadTrajectory(Path(truth_path));
  ExpectRefusal("slam-fit seq/groundtruth.txt later.txt",
                {fmt::format("later.txt: shares no stamp with {} (within 0.01 s): it is from "
                             "1000.000 to 1000.000 s, that one from {:.3f} to {:.3f} s",
                             truth_path, truth.front().stamp_s, truth.back().stamp_s)});
}

// A path with turns, so that its scale is determined, in units of which `metre` make one metre.
std::string TurningPath(double metre, int frames, double bend) {
  std::string text;
  for (int i = 0; i < frames; ++i) {
    const double t_s = i / 30.0;
    const double x_m = 0.3 * t_s, y_m = bend * std::sin(0.5 * t_s);
    const double z_m = 1.0 + 0.3 * std::sin(0.9 * t_s);
    text += fmt::format("{:.6f} {} {} {} -0.5 0.5 -0.5 0.5\n", t_s, metre * x_m, metre * y_m,
                        metre * z_m);
  }
  return text;
}

TEST_F(SlamCommands, FitRefusesOtherUnits) {
  Write("m.txt", TurningPath(1.0, 600, 1.0));
  Write("mm.txt", TurningPath(1000.0, 600, 1.0));
  Write("cm.txt", TurningPath(100.0, 600, 1.0));
  ExpectRefusal("slam-fit m.txt mm.txt",
                {"mm.txt: seems to be in millimetres where m.txt is in metres, both must be in "
                 "metres\n"});
  ExpectRefusal("slam-fit cm.txt m.txt", {"m.txt: seems to be in metres where cm.txt is in cent"});
  Write("wild.txt", TurningPath(30.0, 600, 3.0));
  Write("odd.txt", TurningPath(3000.0, 600, -3.0));
  ExpectRefusal("slam-fit wild.txt odd.txt", {});
}

TEST_F(SlamCommands, FitWarnsAsEvalTrajectoryDoes) {
  Write("truth.txt", TurningPath(1.0, 900, 1.0));
  Write("part.txt", TurningPath(1.0, 300, 1.0));
  const std::string says = "warning: part.txt: covers 33 % of truth.txt's time";
  EXPECT_THAT(Program("eval trajectory truth.txt part.txt").err, HasSubstr(says));
  EXPECT_THAT(Program("slam-fit truth.txt part.txt").err, HasSubstr(says));
  // Another room's path, whose height varies as the truth's way across does.
  std::string tilted;
  for (int i = 0; i < 900; ++i) {
    const double t_s = i / 30.0;
    tilted += fmt::format("{:.6f} {} {} {} -0.5 0.5 -0.5 0.5\n", t_s, 0.3 * t_s,
                          -0.3 * std::sin(0.9 * t_s), 1.0 + std::sin(0.5 * t_s));
  }
  Write("tilted.txt", tilted);
  const std::string plane = "their worlds are tilted against each other";
  EXPECT_THAT(Program("eval trajectory truth.txt tilted.txt").err, HasSubstr(plane));
  EXPECT_THAT(Program("slam-fit truth.txt tilted.txt").err, HasSubstr(plane));
}

TEST_F(SlamCommands, CalibrateReachesItsTarget) {
  const std::string command =
      "slam-calibrate ./small.yaml --set frames=90 --set slam.loops.scenario=none --seeds 20 ";
  const Outcome found = Program(command + "--target 0.05 --threads 2");
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("mean live error 0.0500 m"));
  const auto at = found.out.find("drift_scale: ");
  ASSERT_NE(at, std::string::npos) << found.out;
  EXPECT_GT(std::stod(found.out.substr(at + 13)), 1.0);
  EXPECT_EQ(Program(command + "--target 0.05 --threads 1").out, found.out);
  const Outcome idle = Program(command + "--target 0.05 --set mapper.fusion.gain=0.3");
  EXPECT_EQ(idle.out, found.out);
  EXPECT_THAT(idle.err, HasSubstr("--set mapper.fusion.gain=0.3: has no effect because only SLAM's "
                                  "own poses are looked at"));
}

TEST_F(SlamCommands, CalibrateRefusesBadInput) {
  ExpectRefusal("slam-calibrate ./small.yaml", {"--target"});
  ExpectRefusal("slam-calibrate ./small.yaml --target=-1", {"--target"});
  ExpectRefusal("slam-calibrate ./nothing.yaml --target 1", {"nothing.yaml"});
  ExpectRefusal("slam-calibrate ./small.yaml --target 0.1 --seeds 0", {"--seeds"});
  ExpectRefusal("slam-calibrate ./small.yaml --target 0.1 --first-seed 18446744073709551615",
                {"--first-seed: 400 seeds from 18446744073709551615 on go beyond"});
  for (const char* key : {"seed", "slam_seed"}) {
    ExpectRefusal(fmt::format("slam-calibrate ./small.yaml --target 0.1 --set {}=3", key),
                  {fmt::format("--set {}=3: give --first-seed N", key)});
  }
  ExpectRefusal("slam-calibrate ./small.yaml --target 0.1 --set slam.drift_scale=3",
                {"--set slam.drift_scale=3: is what this command finds"});
  // Nothing to scale; named is what chose the profile, if anything did.
  const std::string nothing =
      "is ground_truth, whose poses have no error to scale: choose another with --set "
      "slam.profile=NAME\n";
  ExpectRefusal("slam-calibrate ./small.yaml --set slam.profile=ground_truth --target 0.1",
                {"depthgrid: --set slam.profile=ground_truth: slam.profile " + nothing});
  Write("true.yaml", "scene: ./room.yaml\nframes: 6\nslam:\n  profile: ground_truth\n");
  ExpectRefusal("slam-calibrate ./true.yaml --target 0.1",
                {"true.yaml:4: slam.profile " + nothing});
  Write("bare.yaml", "scene: ./room.yaml\nframes: 6\n");
  ExpectRefusal("slam-calibrate ./bare.yaml --target 0.1", {"depthgrid: slam.profile: " + nothing});
}

}  // namespace
}  // namespace depthgrid
