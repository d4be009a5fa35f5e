// Recorded data through the program: each kind of input detected, named and mapped; damage counted
// and survived; each form of output.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "mapper/io/map_file.h"
#include "mapper/io/trajectory_file.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ProgramFormats : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Succeed("render ./small.yaml --no-colour --set sensor.noise=none -o seq");
  }
  // What `map` says on standard output.
  std::string Mapped(const std::string& arguments) const {
    const Outcome outcome = Program("map " + arguments + " -o out --force");
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
    return outcome.out;
  }
  Trajectory Truth() const { return ReadTrajectory(Path("seq/groundtruth.txt")); }
  std::vector<std::string> DepthFiles() const {
    std::vector<std::string> files;
    for (const std::string& file : FilesIn("seq/depth")) files.push_back("seq/depth/" + file);
    return files;
  }
  static std::string Row(const Eigen::Matrix3d& r, const Eigen::Vector3d& t, int row) {
    std::ostringstream text;
    text.precision(17);
    text << r(row, 0) << " " << r(row, 1) << " " << r(row, 2) << " " << t[row];
    return text.str();
  }
  static std::string Matrix(const Pose3& pose, const char* between) {
    const Eigen::Matrix3d r = pose.rotation.toRotationMatrix();
    std::string text;
    for (int row = 0; row < 3; ++row) text += Row(r, pose.translation, row) + between;
    return text + "0 0 0 1";
  }
  // The distance of the estimates to the truth of these frames, both as they are.
  double ErrorM(int begin = 0, int end = 12) const {
    const Trajectory all = Truth();
    const Trajectory truth(all.begin() + begin, all.begin() + end);
    const Trajectory estimate = ReadTrajectory(Path("out/trajectory_est.txt"));
    EXPECT_EQ(estimate.size(), truth.size());
    double worst_m = 0.0;
    for (std::size_t i = 0; i < std::min(truth.size(), estimate.size()); ++i) {
      worst_m = std::max(worst_m, (truth[i].world_from_camera.translation -
                                   estimate[i].world_from_camera.translation)
                                      .head<2>()
                                      .norm());
    }
    return worst_m;
  }
  static constexpr const char* kTrustPoses =
      " --set mapper.fusion.mode=fixed --set mapper.fusion.gain=0";
};

TEST_F(ProgramFormats, ATumFolderWithItsOwnOrGivenPoses) {
  EXPECT_THAT(Mapped(std::string("seq") + kTrustPoses),
              AllOf(HasSubstr("seq: TUM RGB-D folder, 12 frames\n"),
                    HasSubstr("poses: groundtruth.txt of the folder\n"),
                    HasSubstr("mapped 12 of 12 frames\n")));
  const std::string map = ReadFile(Path("out/map.pgm"));
  Mapped(std::string("seq --poses seq/groundtruth.txt --format tum") + kTrustPoses);
  EXPECT_EQ(ReadFile(Path("out/map.pgm")), map);
}

// The same frames in the layouts of other data sets give the same map.
TEST_F(ProgramFormats, FramesWithMatricesAreTheSameFrames) {
  Mapped(std::string("seq") + kTrustPoses);
  const std::string map = ReadFile(Path("out/map.pgm"));
  fs::create_directory(Path("frames"));
  std::string list;
  const Trajectory truth = Truth();
  const auto depth = DepthFiles();
  ASSERT_EQ(depth.size(), truth.size());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const std::string stem = "frames/frame-" + std::to_string(i);
    fs::copy_file(Path(depth[i]), Path(stem + ".depth.png"));
    Write(stem + ".pose.txt", Matrix(truth[i].world_from_camera, "\n") + "\n");
    list += Matrix(truth[i].world_from_camera, " ") + "\n";
  }
  fs::copy_file(Path("seq/camera.yaml"), Path("frames/camera.yaml"));
  EXPECT_THAT(Mapped(std::string("frames") + kTrustPoses),
              HasSubstr("frames: folder of frames, 12 frames\n"));
  EXPECT_TRUE(ReadFile(Path("out/map.pgm")) == map);
  for (const std::string& file : FilesIn("frames")) {
    if (file.ends_with("pose.txt")) fs::remove(Path("frames/" + file));
  }
  Write("frames/poses.txt", list);
  Mapped(std::string("frames") + kTrustPoses);
  EXPECT_TRUE(ReadFile(Path("out/map.pgm")) == map);
  Mapped(std::string("seq --poses frames/poses.txt") + kTrustPoses);
  EXPECT_TRUE(ReadFile(Path("out/map.pgm")) == map);
}

TEST_F(ProgramFormats, AWorldInCameraAxesIsMadeLevel) {
  const Trajectory truth = Truth();
  const Pose3 first_from_world = Inverse(truth[0].world_from_camera);
  Trajectory slam;
  for (const StampedPose& pose : truth) {
    slam.push_back({pose.stamp_s, first_from_world * pose.world_from_camera});
  }
  WriteTrajectory(Path("slam.txt"), slam);
  const std::string said = Mapped(std::string("seq --poses slam.txt") + kTrustPoses);
  EXPECT_THAT(said, AllOf(HasSubstr("removed "), HasSubstr("the camera is 1.1")));
  // As many walls as with upright poses.
  const auto walls = [&] {
    const OccupancyMap map = ReadMap(Path("out/map.yaml")).map;
    return std::count(map.occupied_prob.begin(), map.occupied_prob.end(), 1.0F);
  };
  const auto found = static_cast<double>(walls());
  Mapped(std::string("seq") + kTrustPoses);
  EXPECT_NEAR(found, static_cast<double>(walls()), 0.3 * found);
  EXPECT_GT(found, 20.0);
}

TEST_F(ProgramFormats, WhatHasNoEffectIsSaid) {
  Write("robot.log",
        "ROBOTLASER1 0 -1.57 3.14 0.785 30 0.01 0 5 2.0 2.1 2.2 2.1 2.0 0 "
        "0 0 0 0 0 0 0 0 0 0 0 1 host 0\n");
  const auto said = [&](const std::string& arguments) {
    const Outcome outcome = Program("map " + arguments + " -o out --force");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  };
  const std::string of_log = ": has no effect because robot.log is a CARMEN laser log\n";
  for (const char* set : {"mapper.scan.max_range_m=2", "mapper.scan.band_low_m=0.3",
                          "sequence.recording.time_offset_s=5", "sequence.world_up=x"}) {
    EXPECT_EQ(said(std::string("robot.log --set ") + set),
              std::string("depthgrid: warning: --set ") + set + of_log);
  }
  const std::string of_gain =
      "depthgrid: warning: --set mapper.fusion.gain=0.1: has no effect because "
      "mapper.fusion.mode is learned\n";
  EXPECT_EQ(said("robot.log --set mapper.fusion.gain=0.1"), of_gain);
  EXPECT_EQ(said("seq --set mapper.fusion.gain=0.1"), of_gain);
  EXPECT_EQ(ReadFile(Path("out/warnings.txt")), of_gain.substr(of_gain.find("--set")));
  EXPECT_EQ(said("seq --set sequence.laser.max_range_m=2"),
            "depthgrid: warning: --set sequence.laser.max_range_m=2: has no effect because seq is "
            "a TUM RGB-D folder\n");
  EXPECT_EQ(said("seq --set sequence.recording.max_interpolation_gap_s=1"),
            "depthgrid: warning: --set sequence.recording.max_interpolation_gap_s=1: has no effect "
            "because sequence.recording.interpolate_poses is false\n");
  // With an effect, or what it would be anyway.
  EXPECT_EQ(said("robot.log --set sequence.laser.max_range_m=20 --set mapper.scan.max_range_m=6"),
            "");
  EXPECT_EQ(said(std::string("seq --set mapper.scan.max_range_m=4") + kTrustPoses), "");
  for (const char* option : {"--camera seq/camera.yaml", "--up x"}) {
    const Outcome outcome = Program(std::string("map robot.log -o out2 ") + option);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(std::string("depthgrid: ") + option + ": a laser log"));
  }
}

TEST_F(ProgramFormats, AnAxisThatIsNotUpIsWarnedOf) {
  const auto said = [&](const std::string& arguments) {
    const Outcome outcome = Program("map seq --poses seq/groundtruth.txt -o out --force" +
                                    std::string(kTrustPoses) + " " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  };
  EXPECT_EQ(said("--up z"), "");
  EXPECT_THAT(said("--up x"),
              HasSubstr("depthgrid: warning: --up x: the floor seen in the images says z, if they "
                        "are upright\n"));
  EXPECT_THAT(ReadFile(Path("out/warnings.txt")), HasSubstr("--up x: the floor"));
  EXPECT_THAT(said("--set sequence.world_up=-z"),
              HasSubstr("warning: --set sequence.world_up=-z: the floor seen in the images says z, "
                        "if they are upright; if the camera is mounted upside down (--set "
                        "sequence.recording.upside_down=true), that is the ceiling\n"));
}

TEST_F(ProgramFormats, PosesThatMeanSomethingElseAreNamed) {
  Succeed("render ./small.yaml --no-colour --set frames=150 -o long");
  const Trajectory truth = ReadTrajectory(Path("long/groundtruth.txt"));
  Trajectory inverse = truth, late = truth;
  for (StampedPose& pose : inverse) pose.world_from_camera = Inverse(pose.world_from_camera);
  for (StampedPose& pose : late) pose.stamp_s += 0.5;
  WriteTrajectory(Path("inverse.txt"), inverse);
  WriteTrajectory(Path("late.txt"), late);
  const auto said = [&](const std::string& arguments) {
    const Outcome outcome = Program("map long -o out --force " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(said("--poses inverse.txt"),
              AllOf(HasSubstr("inverse.txt: the depth images do not fit the poses"),
                    HasSubstr("with each pose inverted; poses must take the camera to the world")));
  EXPECT_THAT(ReadFile(Path("out/warnings.txt")), HasSubstr("with each pose inverted"));
  // The remedy as it is said helps.
  const std::string late_said = said("--poses late.txt");
  const auto at = late_said.find("--set sequence.recording.time_offset_s=0.");
  ASSERT_NE(at, std::string::npos) << late_said;
  const std::string remedy = late_said.substr(at, late_said.find('\n', at) - at);
  EXPECT_NEAR(std::stod(remedy.substr(remedy.find('=') + 1)), 0.5, 0.05);
  EXPECT_THAT(said("--poses late.txt " + remedy), Not(HasSubstr("do not fit")));
  EXPECT_EQ(said("--poses long/groundtruth.txt"), "");
  Trajectory unturned = truth;
  for (StampedPose& pose : unturned) pose.world_from_camera.rotation.setIdentity();
  WriteTrajectory(Path("unturned.txt"), unturned);
  EXPECT_THAT(said("--poses unturned.txt"), HasSubstr("the poses do not turn"));
}

TEST_F(ProgramFormats, AForcedKindThatDoesNotFitIsRefused) {
  for (const char* kind : {"icl", "frames", "carmen", "kinect"}) {
    const Outcome outcome = Program(std::string("map seq --format ") + kind + " -o out");
    EXPECT_EQ(outcome.exit_code, 2) << kind;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(Path("out")));
  }
}

TEST_F(ProgramFormats, DamageIsCountedAtTheEnd) {
  const auto depth = DepthFiles();
  fs::remove(Path(depth[3]));
  WriteFile(Path(depth[5]), ReadFile(Path(depth[5])).substr(0, 100));
  std::string poses = "# stamp tx ty tz qx qy qz qw\n";
  const Trajectory truth = Truth();
  for (std::size_t i = truth.size(); i-- > 0;) {  // backwards, one without a pose, one twice
    if (i == 7) {
      poses += std::to_string(truth[i].stamp_s) + " nan 0 0 0 0 0 1\n";
    } else {
      poses += TrajectoryText({truth[i]});
      if (i == 2) poses += TrajectoryText({truth[i]});
    }
  }
  Write("poses.txt", poses);
  const Outcome outcome = Program("map seq --poses poses.txt -o out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("mapped 9 of 12 frames, 1 without a pose\n"));
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("poses.txt: 1 pose with NaN"), HasSubstr("rows earlier than"),
                    HasSubstr("1 row with a stamp already given"),
                    HasSubstr("2 depth images missing or damaged"),
                    HasSubstr("1 of 12 frames has no pose")));
  // The folder keeps what was said, and its page shows it.
  const std::string kept = ReadFile(Path("out/warnings.txt"));
  EXPECT_EQ(std::count(kept.begin(), kept.end(), '\n'),
            std::count(outcome.err.begin(), outcome.err.end(), '\n'));
  EXPECT_THAT(kept, HasSubstr("seq: 1 of 12 frames has no pose\n"));
  EXPECT_THAT(ReadFile(Path("out/report.html")), HasSubstr("seq: 1 of 12 frames has no pose"));
  Mapped("seq");
  EXPECT_THAT(ReadFile(Path("out/warnings.txt")), Not(HasSubstr("no pose")));
}

// Rows of lists and poses; what is cut, empty or mostly damaged.
TEST_F(ProgramFormats, DamagedRowsAreCountedAtTheEnd) {
  const std::string depth = ReadFile(Path("seq/depth.txt"));
  const std::string poses = ReadFile(Path("seq/groundtruth.txt"));
  WriteFile(Path("seq/depth.txt"), "garbage\n" + depth.substr(0, depth.size() - 20));
  Write("slam.txt", poses.substr(0, poses.size() - 1));
  const Outcome outcome = Program("map seq --poses slam.txt -o out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("mapped 11 of 11 frames"));
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("seq/depth.txt: 2 damaged rows left out (first: seq/depth.txt:1: "),
                    HasSubstr("slam.txt: the last line has no line end"),
                    HasSubstr("slam.txt: 1 pose with the stamp of no input frame")));
  Write("empty.csv", "");
  Write("rows.txt", "1 2 3\n4 5 6\n" + poses.substr(0, 100));
  for (const char* bad : {"slam.txt --loops empty.csv", "rows.txt", "empty.csv"}) {
    const Outcome refused = Program(std::string("map seq -o out2 --poses ") + bad);
    EXPECT_EQ(refused.exit_code, 2) << bad;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_FALSE(fs::exists(Path("out2")));
  }
}

TEST_F(ProgramFormats, LoopsOfEveryKind) {
  const Trajectory truth = Truth();
  const auto stamp = [&](std::size_t i) { return std::to_string(truth[i].stamp_s); };
  const Pose3 last_from_first =
      Inverse(truth.back().world_from_camera) * truth.front().world_from_camera;
  const Eigen::Matrix3d r = last_from_first.rotation.toRotationMatrix();
  std::string tcm;
  for (int row = 0; row < 3; ++row) tcm += " " + Row(r, last_from_first.translation, row);
  Write("events.txt", "LOOP 11 " + stamp(11) + " 0 " + stamp(0) + " Tcm" + tcm + "\n");
  EXPECT_THAT(Mapped("seq --poses seq/groundtruth.txt --loops events.txt"),
              AllOf(HasSubstr("1 loop closure from ORB-SLAM2 events\n"),
                    HasSubstr("; 1 of 1 loop closure taken\n")));
  Write("stamped.txt", stamp(0) + " " + stamp(11) + " 0 0 0 0 0 0 1\n");
  EXPECT_THAT(Mapped("seq --poses seq/groundtruth.txt --loops stamped.txt"),
              AllOf(HasSubstr("1 loop closure from stamped loops\n"),
                    HasSubstr("; 0 of 1 loop closure taken\n")));  // wrong: the camera turned
  EXPECT_EQ(Program("map seq --loops events.txt -o out2").exit_code, 2);
}

TEST_F(ProgramFormats, MapsInEveryModeOfNav2) {
  Mapped("seq");
  const StateMap trinary = StatesOf(ReadMap(Path("out/map.yaml")).map);
  for (const char* mode : {"scale", "raw"}) {
    Mapped(std::string("seq --map-mode ") + mode);
    EXPECT_THAT(ReadFile(Path("out/map.yaml")), HasSubstr(std::string("mode: ") + mode));
    EXPECT_EQ(StatesOf(ReadMap(Path("out/map.yaml")).map).states, trinary.states) << mode;
  }
  Succeed("regrid out --resolution 0.05 --map-mode trinary");
  EXPECT_EQ(StatesOf(ReadMap(Path("out/map_0.05.yaml")).map).states, trinary.states);
  EXPECT_EQ(Program("map seq --map-mode grey -o out2").exit_code, 2);
}

TEST_F(ProgramFormats, TrajectoriesAndGraphForOtherPrograms) {
  Mapped("seq");
  const std::string kitti = ReadFile(Path("out/trajectory_est_kitti.txt"));
  EXPECT_EQ(std::count(kitti.begin(), kitti.end(), '\n'), 12);
  const std::string graph = ReadFile(Path("out/pose_graph.g2o"));
  EXPECT_THAT(graph, AllOf(HasSubstr("VERTEX_SE2 0 "), HasSubstr("VERTEX_SE2 11 "),
                           HasSubstr("EDGE_SE2 10 11 ")));
  EXPECT_FALSE(FilesIn("out/frames").empty());  // beams over the depth image
}

TEST_F(ProgramFormats, AVideoTheSameEachTime) {
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
  Mapped("seq --video one.mp4");
  Mapped("seq --video two.mp4");
  EXPECT_GT(ReadFile(Path("one.mp4")).size(), 1000U);
  EXPECT_EQ(ReadFile(Path("one.mp4")).substr(4, 4), "ftyp");
  EXPECT_TRUE(SameFile("one.mp4", "two.mp4"));
  const std::string first = ReadFile(Path("one.mp4"));
  const Outcome again = Program("map seq --video one.mp4 -o out2");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("one.mp4: is there already; choose another name, or --force"));
  EXPECT_TRUE(ReadFile(Path("one.mp4")) == first);
  const Outcome outcome = Program("map seq --video nowhere/one.mp4 -o out2");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_FALSE(fs::exists(Path("out2")));
}

// A second camera through the same room, in a frame of its own, in the finished map of the first.
TEST_F(ProgramFormats, AFinishedMapIsLocalisedInAndExtended) {
  Succeed("map seq -o first --set mapper.fusion.mode=fixed");
  Trajectory moved;
  for (const StampedPose& pose : Truth()) {
    const Pose3 other_from_world = Lift(Pose2{4.0, -1.0, 2.0});
    moved.push_back({pose.stamp_s, other_from_world * pose.world_from_camera});
  }
  WriteTrajectory(Path("moved.txt"), moved);
  for (const char* method : {"surfel", "paper"}) {
    const std::string settings =
        std::string(" --set mapper.fusion.mode=fixed --set mapper.method=") + method;
    EXPECT_THAT(Mapped("seq --poses moved.txt --map first --localise" + settings),
                HasSubstr("first: 12 scans; SLAM's frame lies at ("));
    for (const char* file : {"map.pgm", "map.yaml", "scans.bin", "matched.bin"}) {
      EXPECT_TRUE(SameFile(std::string("out/") + file, std::string("first/") + file)) << file;
    }
    EXPECT_LT(ErrorM(), 0.1) << method;
    EXPECT_EQ(ReadFile(Path("out/warnings.txt")).find("made with") != std::string::npos,
              std::string(method) == "paper");
    EXPECT_THAT(Mapped("seq --poses moved.txt --map first" + settings),
                HasSubstr("mapped 12 of 12 frames"));
    EXPECT_LT(ErrorM(), 0.1) << method;
    EXPECT_GT(ReadFile(Path("out/scans.bin")).size(), ReadFile(Path("first/scans.bin")).size());
  }
  EXPECT_THAT(
      ReadFile(Path("out/warnings.txt")),
      HasSubstr("first/run.yaml: the map was made with mapper.method=surfel, and here it is "
                "paper: give the same --set\n"));
  Mapped(
      "seq --poses moved.txt --map first --set mapper.fusion.gain=0.3 --set "
      "mapper.grid.resolution_m=0.1 --set mapper.scan.band_low_m=0.2");
  EXPECT_THAT(ReadFile(Path("out/warnings.txt")),
              HasSubstr("the map was made with mapper.scan.band_low_m=0.1, "
                        "mapper.grid.resolution_m=0.05, and here it is 0.2, 0.1: give the same"));
  EXPECT_EQ(Program("map seq --map seq -o out2").exit_code, 2);
  EXPECT_EQ(Program("map seq --localise -o out2").exit_code, 2);
}

// A part of the frames, with all that belongs to the whole recording.
TEST_F(ProgramFormats, APartOfAFolder) {
  const Trajectory truth = Truth();
  const std::string part = fmt::format(" --set sequence.from_s={} --set sequence.to_s={}",
                                       truth[4].stamp_s, truth[9].stamp_s);
  const std::string files = "seq --poses seq/groundtruth.txt --final-poses seq/groundtruth.txt";
  EXPECT_THAT(Mapped(files + part), AllOf(HasSubstr("seq: TUM RGB-D folder, 5 frames\n"),
                                          HasSubstr("the part of it: frames 4 to 8 of 12, "),
                                          HasSubstr("mapped 5 of 5 frames\n")));
  EXPECT_EQ(ReadFile(Path("out/warnings.txt")), "");
  EXPECT_TRUE(fs::exists(Path("out/frames/000004_depth.png")));
  EXPECT_LT(ErrorM(4, 9), 0.05);
  fs::rename(Path("out/trajectory_est_kitti.txt"), Path("kitti.txt"));
  Mapped("seq --poses kitti.txt" + part + kTrustPoses);
  EXPECT_LT(ErrorM(4, 9), 0.05);
  Mapped("seq");
  fs::rename(Path("out"), Path("first"));
  EXPECT_THAT(Mapped(files + " --map first --localise" + part), HasSubstr("placed 5 of 5 frames"));
  EXPECT_LT(ErrorM(4, 9), 0.05);
}

}  // namespace
}  // namespace depthgrid
