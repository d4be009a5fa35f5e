// The program end to end: what a run leaves behind, and that it is always the same.
#include "tests/eval/program.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;

class ProgramRun : public ProgramTest {};

TEST_F(ProgramRun, WritesTheWholeFolder) {
  Succeed("run ./small.yaml -o out");
  EXPECT_THAT(FilesIn("out"),
              IsSupersetOf({"run.yaml", "map.pgm", "map.yaml", "map.png", "truth_map.pgm",
                            "truth_map.yaml", "observable.pgm", "trajectory_truth.txt",
                            "trajectory_slam.txt", "trajectory_est.txt", "trajectory_online.txt",
                            "loops.csv", "frames.csv", "warnings.txt", "metrics.json",
                            "timing.json", "timing.csv", "timing.js", "report.html"}));
  EXPECT_EQ(ReadTrajectory(Path("out/trajectory_est.txt")).size(), 12U);
  const auto metrics = nlohmann::json::parse(ReadFile(Path("out/metrics.json")));
  for (const char* which : {"slam", "est"}) {
    for (const char* key : {"mean_euclidean_m", "ate_rmse_se2_m", "mean_euclidean_xyz_m"}) {
      EXPECT_TRUE(metrics["trajectory"][which][key].is_number()) << which << key;
    }
  }
  for (const char* cells : {"observable", "all"}) {
    for (const char* key : {"precision", "recall", "f1"}) {
      EXPECT_TRUE(metrics["map"][cells]["occupied"][key].is_number()) << cells << key;
    }
  }
  EXPECT_TRUE(metrics["map"]["chamfer_m"].is_number());
  EXPECT_TRUE(metrics["map"]["coverage"].is_number());
  const auto timing = nlohmann::json::parse(ReadFile(Path("out/timing.json")));
  EXPECT_EQ(timing["frames"], 12);
  for (const char* key :
       {"cpu_us_per_frame_mean", "cpu_us_per_frame_median", "cpu_us_per_frame_p95",
        "cpu_us_per_frame_max", "cpu_s_total", "wall_s_total", "peak_rss_mib"}) {
    EXPECT_GT(timing[key].get<double>(), 0.0) << key;
  }
}

// The library brings LLVM along; a robot's computer may well be without it.
TEST_F(ProgramRun, IsWholeWithoutColourWhereItCannotBeDrawn) {
  std::filesystem::create_directory(Path("lib"));
  Write("lib/libOSMesa.so.8", "no library");
  const Outcome outcome = Program("run ./small.yaml -o out", "LD_LIBRARY_PATH=lib ");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("warning: pictures in colour are left out: libOSMesa.so.8"));
  EXPECT_THAT(FilesIn("out"), IsSupersetOf({"map.pgm", "metrics.json", "report.html"}));
  EXPECT_THAT(FilesIn("out/frames"), Not(IsEmpty()));
  const Outcome render = Program("render ./small.yaml -o images", "LD_LIBRARY_PATH=lib ");
  EXPECT_EQ(render.exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(Path("images")));
}

TEST_F(ProgramRun, TruePosesGiveTheTrueMap) {
  Succeed(
      "run ./small.yaml --set slam.profile=ground_truth --set sensor.noise=none "
      "--set mapper.fusion.gain=0 --set frames=0 -o out");
  const auto metrics = nlohmann::json::parse(ReadFile(Path("out/metrics.json")));
  EXPECT_EQ(metrics["trajectory"]["est"]["mean_euclidean_xyz_m"], 0.0);
  EXPECT_GE(metrics["map"]["observable"]["occupied"]["f1"], 0.97);
  EXPECT_GE(metrics["map"]["coverage"], 0.9);  // 80 x 60 pixels leave gaps at the room's far end
  EXPECT_TRUE(SameFile("out/trajectory_est.txt", "out/trajectory_truth.txt"));
}

TEST_F(ProgramRun, IsTheSameBytesAtAnyThreadCountAndTwice) {
  Succeed("run ./small.yaml --threads 1 -o one");
  Succeed("run ./small.yaml --threads 1 -o again");
  Succeed("run ./small.yaml --threads 3 -o three");
  ExpectSameBytes("one", "again");
  ExpectSameBytes("one", "three");
}

TEST_F(ProgramRun, IsTheSameBytesWithAColdAWarmAndADamagedCache) {
  Succeed("run ./small.yaml --no-cache -o none");
  Succeed("run ./small.yaml --cache cache -o cold");
  const auto images_kept = [&] {
    std::vector<std::string> files = FilesIn("cache");
    std::erase_if(files, [](const std::string& file) { return file.starts_with("mesa_"); });
    return files;
  };
  const auto entries = images_kept();
  ASSERT_EQ(entries.size(), 12U);
  Succeed("run ./small.yaml --cache cache -o warm");
  EXPECT_EQ(images_kept(), entries);
  std::string damaged = ReadFile(Path("cache/" + entries[0]));
  damaged[damaged.size() / 2] ^= 1;
  Write("cache/" + entries[0], damaged);
  Write("cache/" + entries[1], ReadFile(Path("cache/" + entries[1])).substr(0, 1000));
  Write("cache/" + entries[2], "");
  Succeed("run ./small.yaml --cache cache -o damaged");
  for (const char* run : {"cold", "warm", "damaged"}) ExpectSameBytes("none", run);
  EXPECT_TRUE(ReadFile(Path("cache/" + entries[0])) != damaged);  // rendered and stored anew
}

TEST_F(ProgramRun, ItsOwnSettingsGiveItAgain) {
  Succeed("run ./small.yaml --set seed=5 -o out");
  Succeed("run out/run.yaml -o again");
  ExpectSameBytes("out", "again");
}

TEST_F(ProgramRun, AMapsOwnSettingsGiveItAgain) {
  Succeed("render ./small.yaml --no-colour -o seq");
  Succeed("slam seq -o slam");
  Succeed("map seq --poses slam/slam.txt --loops slam/loops.csv --up z -o out");
  Succeed("map out/run.yaml -o again");
  ExpectSameBytes("out", "again");
  Succeed("map out/run.yaml --set mapper.grid.resolution_m=0.1 -o coarse");
  EXPECT_THAT(ReadFile(Path("coarse/map.yaml")), HasSubstr("resolution: 0.1"));
  const Outcome mistaken = Program("run out/run.yaml -o other");
  EXPECT_EQ(mistaken.exit_code, 2);
  EXPECT_THAT(mistaken.err, HasSubstr("is the run.yaml of a map; `depthgrid map` takes it"));
  const Outcome other_way = Program("map ./small.yaml -o other");
  EXPECT_EQ(other_way.exit_code, 2);
  EXPECT_THAT(other_way.err, HasSubstr("is an experiment; `depthgrid run` takes it"));
}

TEST_F(ProgramRun, WhatAnotherCommandTakesIsSaidToBeIts) {
  Succeed("render ./small.yaml --no-colour -o seq");
  Succeed("map seq -o out");
  const auto said = [&](const std::string& command) {
    const Outcome refused = Program(command + " -o other");
    EXPECT_EQ(refused.exit_code, 2) << command;
    return refused.err;
  };
  EXPECT_THAT(said("run seq"),
              HasSubstr("depthgrid: seq: is a folder, must be an experiment's YAML "
                        "file; `depthgrid map` takes folders"));
  EXPECT_THAT(said("sweep seq"), HasSubstr("seq: is a folder, must be a sweep's YAML file"));
  EXPECT_THAT(said("map living_room"),
              HasSubstr("living_room: is a shipped experiment; `depthgrid run` takes it"));
  EXPECT_THAT(said("report seq"), HasSubstr("depthgrid: seq: is a sequence, no run's folder; "
                                            "`depthgrid map seq -o OUT` makes a run of it\n"));
  EXPECT_THAT(said("map out"), HasSubstr("depthgrid: out: is the folder of a finished run, no"));
  Write("mine", "scene: ./room.yaml\n");
  EXPECT_THAT(said("run mine"),
              HasSubstr("mine: no shipped experiment has this name; the file is ./mine"));
  // A map may lie in its recording's folder.
  Succeed("map seq -o seq --force");
  Succeed("map seq -o third");
}

TEST_F(ProgramRun, SaysWhichInstructionSetCastItsRays) {
  const auto says = [&](const std::string& folder, const std::string& isa) {
    EXPECT_THAT(ReadFile(Path(folder + "/run.yaml")), HasSubstr("ray_instruction_set: " + isa));
  };
  Succeed("run ./small.yaml -o usual");
  says("usual", "avx2\n");
  if (!__builtin_cpu_supports("avx512vl")) GTEST_SKIP() << "no AVX-512 on this machine";
  Succeed("run ./small.yaml --set sensor.isa=avx512 -o wide");
  says("wide", "avx512\n");
}

TEST_F(ProgramRun, RenderSlamAndMapGiveWhatRunGives) {
  Succeed("run ./small.yaml -o run");
  Succeed("render ./small.yaml -o seq");
  Succeed("slam seq --profile orb_slam2 --seed 1 -o slam");
  Succeed(
      "map seq --poses slam/slam.txt --final-poses slam/slam_final.txt --loops slam/loops.csv "
      "--set mapper.fusion.mode=fixed --set mapper.fusion.gain=0.5 -o map");
  for (const char* file : {"map.pgm", "map.yaml", "trajectory_slam.txt", "trajectory_est.txt",
                           "trajectory_online.txt", "scans.bin"}) {
    EXPECT_TRUE(SameFile(std::string("run/") + file, std::string("map/") + file)) << file;
  }
  EXPECT_TRUE(SameFile("seq/truth_map.pgm", "run/truth_map.pgm"));
  EXPECT_TRUE(SameFile("seq/observable.pgm", "run/observable.pgm"));
}

TEST_F(ProgramRun, RenderAndSlamSayTheNextCommand) {
  const auto next = [&](const std::string& command, const std::string& says) {
    const Outcome outcome = Program(command);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const std::string start = "go on with: depthgrid ";
    const std::size_t at = outcome.out.find(start);
    EXPECT_EQ(outcome.out.substr(0, outcome.out.find('\n')), says);
    return at == std::string::npos ? "" : outcome.out.substr(at + start.size());
  };
  const auto without_line_end = [](std::string text) { return text.substr(0, text.size() - 1); };
  const std::string slam =
      next("render ./small.yaml -o 'a room'",
           "rendered 12 frames in a room; the true map is a room/truth_map.yaml");
  EXPECT_EQ(slam, "slam 'a room' -o POSES\n");
  const std::string map = next(without_line_end(slam) + " --set slam.loops.scenario=none",
                               "SLAM gives 12 of 12 frames a pose and closes 0 loops: "
                               "POSES/slam.txt");
  EXPECT_EQ(map, "map 'a room' --poses POSES/slam.txt --loops POSES/loops.csv --up z -o OUT\n");
  EXPECT_THAT(Program(without_line_end(map)).out, testing::HasSubstr("mapped 12 of 12 frames"));
}

// A planar sensor's poses are the log's own: x, y and the yaw about z, at height 0.
TEST_F(ProgramRun, ALaserLogsTrajectoriesAreInTheLogsConvention) {
  Write("robot.log",
        "ROBOTLASER1 0 -0.2 0.4 0.1 6.0 0.01 0 5 2 2 2 2 2 0 1.5 -2 0.25 1.5 -2 0.25 0 0 0 0 0 "
        "10.5 host 10.5\n");
  Succeed("map robot.log -o out");
  for (const char* file : {"trajectory_slam.txt", "trajectory_online.txt", "trajectory_est.txt"}) {
    const Trajectory poses = ReadTrajectory(Path(std::string("out/") + file));
    ASSERT_EQ(poses.size(), 1U);
    EXPECT_EQ(poses[0].stamp_s, 10.5);
    EXPECT_LT((poses[0].world_from_camera.translation - Eigen::Vector3d(1.5, -2, 0)).norm(), 1e-9);
    EXPECT_NEAR(poses[0].world_from_camera.rotation.z(), std::sin(0.125), 1e-9);
    EXPECT_NEAR(poses[0].world_from_camera.rotation.w(), std::cos(0.125), 1e-9);
  }
}

TEST_F(ProgramRun, EvalPrintsTheKeysOfMetricsJson) {
  Succeed("run ./small.yaml -o out");
  auto metrics = nlohmann::json::parse(ReadFile(Path("out/metrics.json")));
  const auto trajectory = nlohmann::json::parse(
      Program("eval trajectory out/trajectory_truth.txt out/trajectory_est.txt --json").out);
  EXPECT_EQ(trajectory["trajectory"]["est"], metrics["trajectory"]["est"]);
  const auto map =
      nlohmann::json::parse(Program("eval map out/truth_map.yaml out/map.yaml --json").out);
  EXPECT_TRUE(metrics["map"]["calibration"].is_object());
  metrics["map"]["calibration"] = nullptr;  // map.pgm keeps states, not probabilities
  EXPECT_EQ(map["map"], metrics["map"]);
  EXPECT_THAT(Program("eval map out/truth_map.yaml out/map.yaml").out, HasSubstr("chamfer"));
}

TEST_F(ProgramRun, RegridAtTheSameResolutionGivesTheSameMap) {
  Succeed("run ./small.yaml -o out");
  Succeed("regrid out --resolution 0.05");
  EXPECT_TRUE(SameFile("out/map_0.05.pgm", "out/map.pgm"));
  Succeed("regrid out --resolution 0.02");
  EXPECT_GT(ReadFile(Path("out/map_0.02.pgm")).size(), 4 * ReadFile(Path("out/map.pgm")).size());
}

TEST_F(ProgramRun, ReportWritesTheSamePageAgain) {
  Succeed("run ./small.yaml -o out");
  const std::string page = ReadFile(Path("out/report.html"));
  std::filesystem::remove(Path("out/report.html"));
  Succeed("report out");
  EXPECT_EQ(Difference(ReadFile(Path("out/report.html")), page), "");
}

TEST_F(ProgramRun, ReportOfALaserLogHasItsHeadings) {
  std::string log;
  for (int i = 0; i < 3; ++i) {
    log += "FLASER 181";
    for (int beam = 0; beam < 181; ++beam) log += " 2.0";
    const std::string stamp = std::to_string(0.1 * i);
    log += " 1 2 0.5 1 2 0.5 " + stamp + " robot " + stamp + "\n";
  }
  Write("robot.log", log);
  Succeed("map robot.log -o out");
  const std::string page = ReadFile(Path("out/report.html"));
  const std::string before = "<script type=\"application/json\" id=\"data\">";
  const std::size_t start = page.find(before) + before.size();
  const auto data =
      nlohmann::json::parse(page.substr(start, page.find("</script>", start) - start));
  EXPECT_EQ(data["paths"]["slam"]["yaw"], (std::vector<double>{0.5, 0.5, 0.5}));
  EXPECT_EQ(data["input_poses"], "odometry");
}

// Drift calibrated for one SLAM is another one's by mistake only.
TEST_F(ProgramRun, WhatStaysBesideAnotherProfileIsSaid) {
  Write("drifts.yaml", std::string("scene: ./room.yaml\nframes: 3\n") +
                           "sensor: {width: 80, height: 60}\n"
                           "slam: {profile: orb_slam2, drift_scale: 20, pivot_m: 1}\n");
  const auto said = [&](const std::string& set) {
    return Program("run ./drifts.yaml -o out --force" + set).err;
  };
  EXPECT_EQ(said(" --set slam.profile=planar_slam --set slam.pivot_m=1.5"),
            "depthgrid: warning: ./drifts.yaml: its own values of slam.drift_scale are kept with "
            "slam.profile=planar_slam\n");
  EXPECT_EQ(said(" --set slam.profile=orb_slam2"), "");
  EXPECT_EQ(said(" --set slam.profile=ground_truth"), "");
  EXPECT_EQ(said(" --set slam.drift_scale=2"), "");
}

// Mesa would keep compiled shaders among the user's.
TEST_F(ProgramRun, LeavesTheUsersCacheAlone) {
  std::filesystem::create_directory(Path("users"));
  ::setenv("XDG_CACHE_HOME", Path("users").c_str(), 1);
  Succeed("render ./small.yaml -o images --set frames=2");
  Succeed("render ./small.yaml -o images --force --set frames=2 --cache cache");
  ::unsetenv("XDG_CACHE_HOME");
  EXPECT_THAT(FilesIn("users"), IsEmpty());
}

TEST_F(ProgramRun, WhatHasNoEffectIsSaid) {
  const auto said = [&](const std::string& set) {
    return Program("run ./small.yaml -o out --force --set frames=3" + set).err;
  };
  EXPECT_EQ(said(" --set mapper.fusion.mode=learned --set mapper.fusion.gain=0.3"),
            "depthgrid: warning: --set mapper.fusion.gain=0.3: has no effect because "
            "mapper.fusion.mode is learned\n");
  EXPECT_EQ(said(" --set sensor.noise=none --set sensor.noise_scale=2"),
            "depthgrid: warning: --set sensor.noise_scale=2: has no effect because sensor.noise is "
            "none\n");
  EXPECT_EQ(said(" --set mapper.match.min_score=0.3"),
            "depthgrid: warning: --set mapper.match.min_score=0.3: has no effect because "
            "mapper.method is surfel\n");
  EXPECT_EQ(said(" --set mapper.method=paper --set mapper.match.min_score=0.3"), "");
  EXPECT_EQ(said(" --set mapper.fusion.gain=0.3 --set seed=4 --set slam.drift_scale=2"), "");
  // What is said to be as it would be anyway is no mistake, but where nothing errs a seed is one.
  EXPECT_EQ(said(" --set slam_seed=1 --set depth_seed=1"), "");
  EXPECT_EQ(said(" --set slam.profile=ground_truth --set slam_seed=2"),
            "depthgrid: warning: --set slam_seed=2: has no effect because slam.profile is "
            "ground_truth\n");
  EXPECT_EQ(said(" --set 'mapper.fusion={mode: learned, gain: 0.3}'"),
            "depthgrid: warning: --set mapper.fusion={mode: learned, gain: 0.3}: "
            "mapper.fusion.gain has no effect because mapper.fusion.mode is learned\n");
}

// What a user's file states means something, or the user does not know.
TEST_F(ProgramRun, WhatAFileStatesWithoutEffectIsSaid) {
  Write("idle.yaml",
        "scene: ./room.yaml\nframes: 3\nsensor: {width: 80, height: 60, noise_scale: 1}\n"
        "slam: {profile: orb_slam2}\nmapper:\n  fusion:\n    gain: 0.1\n");
  const auto said = [&](const std::string& arguments) {
    return Program("run " + arguments + " -o out --force").err;
  };
  const std::string gain =
      "depthgrid: warning: ./idle.yaml:7: mapper.fusion.gain has no effect because "
      "mapper.fusion.mode is learned\n";
  EXPECT_EQ(said("./idle.yaml"), gain);
  EXPECT_EQ(ReadFile(Path("out/warnings.txt")), gain.substr(gain.find("./idle")));
  EXPECT_EQ(said("./idle.yaml --set mapper.fusion.mode=fixed"), "");
  EXPECT_EQ(said("./small.yaml --set mapper.fusion.mode=learned"), "");  // not the file's fault
  EXPECT_EQ(Program("run out/run.yaml -o again").err, "");               // which states everything
  Succeed("run ./idle.yaml -o idle");
  EXPECT_EQ(Program("run idle/run.yaml -o idle2").err, "");
  Write("study.yaml",
        "frames: 3\nsensor: {width: 80, height: 60}\nscene: ./room.yaml\nslam_seed: 4\n"
        "mapper: {fusion: {mode: fixed, gain: 0.3}}\ncases:\n"
        "  - {name: a, slam: {profile: orb_slam2}}\n"
        "  - {name: b, slam: {profile: planar_slam}, mapper: {fusion: {mode: learned}}}\n"
        "  - {name: c, slam: {profile: ground_truth, drift_scale: 3}}\n");
  std::filesystem::remove_all(Path("out"));  // no study goes into a run's folder
  EXPECT_EQ(said("./study.yaml --set mapper.fusion.adaptive_rate=0.1"),
            "depthgrid: warning: ./study.yaml:9: slam.drift_scale has no effect because "
            "slam.profile is ground_truth\n"
            "depthgrid: warning: --set mapper.fusion.adaptive_rate=0.1: has no effect because "
            "mapper.fusion.mode is fixed\n");
}

TEST_F(ProgramRun, ForceKeepsWhatItDoesNotWrite) {
  Succeed("run ./small.yaml --set frames=2 -o out");
  Write("out/notes.txt", "mine");
  Write("out/map.pgm", "old");
  Succeed("run ./small.yaml --force -o out");
  EXPECT_EQ(ReadFile(Path("out/notes.txt")), "mine");
  EXPECT_NE(ReadFile(Path("out/map.pgm")), "old");
}

// Scores and pictures of another run would be taken for this one's.
TEST_F(ProgramRun, ForceLeavesNothingOfAnEarlierRun) {
  Succeed("render ./small.yaml --no-colour -o seq");
  Succeed("map seq -o once");
  Succeed("run ./small.yaml --set frames=7 -o out");
  std::filesystem::create_directories(Path("out/mine"));
  for (const char* name : {"out/notes.txt", "out/mine/metrics.json", "out/map_edited.pgm",
                           "out/frames/best_depth.png"}) {
    Write(name, "mine");
  }
  Succeed("map seq -o out --force");
  std::vector<std::string> expected = FilesIn("once");
  expected.insert(expected.end(),
                  {"notes.txt", "mine/metrics.json", "map_edited.pgm", "frames/best_depth.png"});
  EXPECT_THAT(FilesIn("out"), testing::UnorderedElementsAreArray(expected));
}

TEST_F(ProgramRun, IsQuietInAPipe) { EXPECT_EQ(Program("run ./small.yaml -o out").err, ""); }

TEST_F(ProgramRun, EveryCommandHasHelpWithAnExample) {
  for (const char* command : {"scenes", "render", "slam", "slam-calibrate", "slam-fit", "map",
                              "run", "regrid", "report", "eval trajectory", "eval map"}) {
    const Outcome help = Program(std::string(command) + " --help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Example:\n  depthgrid " + std::string(command)));
  }
}

TEST_F(ProgramRun, ShippedNamesWorkFromAnywhere) {
  const Outcome outcome = Program("scenes");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* name : {"living_room", "office_room", "office_floor", "handheld"}) {
    EXPECT_THAT(outcome.out, HasSubstr(name));
  }
}

}  // namespace
}  // namespace depthgrid
