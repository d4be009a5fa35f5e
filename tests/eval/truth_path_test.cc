// Camera paths that are read from a file: what is refused, what is only said.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "eval/doubts/storey_check.h"
#include "mapper/core/level.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class TruthPaths : public ProgramTest {};

TEST_F(TruthPaths, AFilesPathOutOfReachIsRefusedAndDamageSaid) {
  const std::string look = " -0.7071068 0 0 0.7071068\n";
  const std::string good = "0 1.5 3.0 1.1" + look + "0.1 1.5 3.2 1.1" + look;
  Write("far.txt", "# stamp pose\n" + good + "0.2 1e6 3.4 1.1" + look);
  Write("close.txt", good + "0.1000002 1.5 3.4 1.1" + look);
  Write("nan.txt", good + "0.2 nan 3.3 1.1" + look + "0.3 1.5 3.4 1.1" + look + "oops\n");
  for (const char* command : {"run", "render --no-colour", "ablate"}) {
    const std::string with = std::string(command) + " ./small.yaml -o out --set frames=0 --set ";
    ExpectRefusal(with + "trajectory=./far.txt",
                  {"far.txt:4: the pose at (1000000.00, 3.40, 1.10) is ",
                   " m from the scene, must be at most 2000 m\n"});
    ExpectRefusal(with + "trajectory=./close.txt",
                  {"close.txt:3: stamp 0.1000002 is that of the pose before it"});
  }
  for (const char* command : {"run", "render --no-colour", "ablate --seeds 1"}) {
    const std::string out = " -o out_" + std::string(command, 3);
    const Outcome outcome = Program(std::string(command) + " ./small.yaml --force" + out +
                                    " --set frames=0 --set trajectory=./nan.txt");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("nan.txt: 1 pose with NaN"));
    EXPECT_THAT(outcome.err, HasSubstr("nan.txt: 1 damaged row left out (first: "));
    EXPECT_THAT(outcome.err, HasSubstr("nan.txt:5: "));
  }
}

TEST_F(TruthPaths, StampsThatAreNoSecondsAreRefused) {
  const std::string look = " -0.7071068 0 0 0.7071068\n";
  const auto path = [&](double step) {
    std::string text;
    for (int i = 0; i < 4; ++i) {
      text += std::to_string(i * step) + " 1.5 3." + std::to_string(i) + " 1.1" + look;
    }
    return text;
  };
  Write("ms.txt", path(33.0));
  Write("ns.txt", path(33e6));
  Write("one.txt", path(0.0));
  Write("slow.txt", path(4.0));
  for (const char* command : {"run", "render --no-colour", "ablate"}) {
    const std::string with = std::string(command) + " ./small.yaml -o out --set frames=0 --set ";
    ExpectRefusal(with + "trajectory=./ms.txt",
                  {"ms.txt: its stamps, which must be seconds, are 33 apart (median), must be at "
                   "most 5\n"});
    ExpectRefusal(with + "trajectory=./ns.txt", {"ns.txt: its stamps, which must be seconds"});
    ExpectRefusal(with + "trajectory=./one.txt",
                  {"one.txt: all of its 4 poses have the stamp 0, must each have a later one"});
  }
  Succeed("run ./small.yaml -o slow --set frames=0 --set trajectory=./slow.txt");
}

// A floor below the one that is there: the room's own is an obstacle.
TEST_F(TruthPaths, ATrueMapWithoutFreeCellsIsWarnedOf) {
  std::string room = kRoom;
  room.replace(room.find("floor_z_m: 0"), 12, "floor_z_m: -0.5");
  room.insert(room.find("  - {shape: box"),
              "  - {shape: box, size: [3, 4, 0.1], at: [1.5, 2, -0.6]}\n");
  Write("room.yaml", room);
  for (const char* command : {"run", "render --no-colour"}) {
    const std::string out = " -o out_" + std::string(command, 3);
    EXPECT_THAT(Program(std::string(command) + " ./small.yaml --set frames=2" + out).err,
                HasSubstr("room.yaml: the true map has no free cell: surfaces are 0.1 to 1.8 m "));
  }
  EXPECT_THAT(ReadFile(Path("out_run/warnings.txt")), HasSubstr("the true map has no free cell"));
  EXPECT_THAT(Program("ablate ./small.yaml --set frames=2 --seeds 1 -o ablated").err,
              HasSubstr("room.yaml: the true map has no free cell: "));
  Write("sweep.yaml", "experiment: ./small.yaml\nset: {frames: 2}\naxes: {seed: [4, 5]}\n");
  const std::string said = Program("sweep ./sweep.yaml -o swept").err;
  const std::string once = "sweep: 2 of 2 runs, the first with seed=4: ";
  EXPECT_THAT(said, HasSubstr(once));
  EXPECT_THAT(said, HasSubstr("room.yaml: the true map has no free cell: "));
  EXPECT_EQ(said.find(once), said.rfind(once + "/")) << said;
}

TEST_F(TruthPaths, APathMostlyAboveObstaclesIsWarnedOf) {
  std::string room = kRoom;
  room.insert(room.find("trajectories:"),
              "  - {shape: box, size: [1, 1, 0.9], at: [1.5, 2.5, 0]}\n");
  Write("block.yaml", room);
  const std::string look = " -0.7071068 0 0 0.7071068\n";
  Write("over.txt", "0 1.5 1.5 1.1" + look + "0.1 1.5 2.2 1.1" + look + "0.2 1.5 2.4 1.1" + look +
                        "0.3 1.5 2.6 1.1" + look);
  const std::string run = "run ./small.yaml --set scene=./block.yaml --set trajectory=./over.txt";
  EXPECT_THAT(Program(run + " --set frames=4 -o out").err,
              HasSubstr("block.yaml: 3 of 4 poses of the camera's path lie where the true map is "
                        "not free: "));
  EXPECT_THAT(Program(run + " --set frames=2 -o half").err,
              testing::Not(HasSubstr("the true map is not free")));
}

constexpr const char* kHouse = R"(shapes:
  - {shape: box, size: [3, 4, 0.2], at: [1.5, 2, -0.2]}
  - {shape: box, size: [3, 4, 0.2], at: [1.5, 2, 2.4]}
  - {shape: box, size: [1, 1, 1.9], at: [0.6, 2, 2.6]}
  - {shape: wall, from: [0, 0], to: [3, 0], side: right, height_m: 6}
  - {shape: wall, from: [3, 0], to: [3, 4], side: right, height_m: 6}
  - {shape: wall, from: [3, 4], to: [0, 4], side: right, height_m: 6}
  - {shape: wall, from: [0, 4], to: [0, 0], side: right, height_m: 6}
trajectories:
  down: {kind: planar, height_m: 1.1, waypoints: [{at: [1.5, 1]}, {at: [1.5, 3]}]}
  up: {kind: planar, height_m: 3.7, waypoints: [{at: [1.5, 1]}, {at: [1.5, 3]}]}
)";

TEST_F(TruthPaths, APathInAnotherStoreyIsWarnedOf) {
  Write("house.yaml", kHouse);
  Write("upper.yaml", "floor_z_m: 2.6\n" + std::string(kHouse));
  const std::string said =
      "house.yaml:11: trajectory 'up': 2 of 2 poses are above a level surface at z = 2.6 m, but "
      "maps are of the storey whose floor is at 0 m; floor_z_m: 2.6 in the scene's file takes the "
      "upper one";
  const std::string with = " ./small.yaml --force --set scene=./house.yaml --set frames=2 ";
  const std::string above = " ./small.yaml --force --set scene=./upper.yaml --set frames=2 ";
  for (const char* command : {"run", "render --no-colour", "ablate --seeds 1"}) {
    const std::string to = std::string(command) + with + "-o out_" + std::string(command, 3);
    EXPECT_THAT(Program(to + " --set trajectory=up").err, HasSubstr(said)) << command;
    EXPECT_THAT(Program(to + " --set trajectory=down").err, Not(HasSubstr("storey"))) << command;
    const std::string upper = std::string(command) + above + "-o upper_" + std::string(command, 3);
    EXPECT_EQ(Program(upper + " --set trajectory=up").err, "");
    EXPECT_THAT(Program(upper).err,
                HasSubstr("upper.yaml:11: trajectory 'down': 2 of 2 poses are below the floor of "
                          "the maps, z = 2.6 m; floor_z_m: 0 in the scene's file takes the storey "
                          "that they are in"));
  }
  Write("sweep.yaml",
        "experiment: ./small.yaml\nset: {scene: ./house.yaml, frames: 2}\n"
        "axes: {trajectory: [down, up], mapper.fusion.gain: [0, 1]}\n");
  const std::string swept = Program("sweep ./sweep.yaml --dry-run -o sweep").err;
  EXPECT_THAT(swept, HasSubstr(said));
  EXPECT_EQ(std::count(swept.begin(), swept.end(), '\n'), 1) << swept;
  EXPECT_THAT(Program("scenes ./upper.yaml").out,
              ContainsRegex("warning: .*upper.yaml:11: trajectory 'down': [0-9]+ of"));
  const std::string look = " -0.7071068 0 0 0.7071068\n";
  Write("path.txt", "0 1.5 1.5 3.7" + look + "0.1 1.5 1.6 3.7" + look);
  EXPECT_THAT(Program("run" + with + "-o file --set trajectory=./path.txt").err,
              HasSubstr("path.txt: 2 of 2 poses are above a level surface at z = 2.6 m"));
  const std::string facts = Program("scenes ./house.yaml").out;
  EXPECT_THAT(facts, ContainsRegex("warning: .*house.yaml:11: trajectory 'up': [0-9]+ of"));
  EXPECT_THAT(facts, Not(HasSubstr("'down'")));
}

TEST_F(TruthPaths, NeitherFurnitureNorStairsAreAnotherStorey) {
  Write("house.yaml", kHouse);
  const Scene scene = LoadScene(Path("house.yaml"));
  const RayScene rays(scene.mesh);
  Trajectory path;
  const auto add = [&](int poses, double x_m, double z_m) {
    for (int i = 0; i < poses; ++i) {
      const Pose2 base{x_m, 2.0, 0.0};
      path.push_back({0.1 * static_cast<double>(path.size()), CameraOf(base, z_m)});
    }
  };
  add(4, 0.6, 5.5);  // a cupboard of 1.9 m in the upper storey
  add(1, 2.0, 5.5);
  EXPECT_FALSE(DoubtOfStorey(path, scene, rays));
  path.clear();
  add(2, 2.0, 1.0);
  add(2, 2.0, 3.6);
  EXPECT_FALSE(DoubtOfStorey(path, scene, rays));
  add(1, 2.0, 3.6);
  EXPECT_THAT(DoubtOfStorey(path, scene, rays).value_or(""), HasSubstr("3 of 5 poses are above"));
  // Above nothing at all.
  path.clear();
  add(3, 9.0, 3.6);
  EXPECT_FALSE(DoubtOfStorey(path, scene, rays));
  // Ten steps of 30 cm.
  std::string stairs = "shapes:\n  - {shape: box, size: [11, 2, 0.1], at: [5, 2, -0.1]}\n";
  for (int i = 1; i <= 10; ++i) {
    stairs +=
        fmt::format("  - {{shape: box, size: [1, 2, {}], at: [{}, 2, 0]}}\n", 0.3 * i, i - 0.5);
  }
  Write("stairs.yaml", stairs);
  const Scene flight = LoadScene(Path("stairs.yaml"));
  path.clear();
  for (int i = 1; i <= 10; ++i) add(5, i - 0.5, 0.3 * i + 1.0);
  EXPECT_FALSE(DoubtOfStorey(path, flight, RayScene(flight.mesh)));
}

TEST_F(TruthPaths, AMapWithoutFreeCellsIsWarnedOf) {
  Write("room.yaml", std::string(kRoom) +
                         "  up: {kind: planar, height_m: 0.6, pitch_deg: 45, "
                         "waypoints: [{at: [1.5, 1]}, {at: [1.5, 2.5]}]}\n");
  const std::string run = "run ./small.yaml --set frames=5 --set trajectory=";
  EXPECT_THAT(Program(run + "up -o up").err, HasSubstr("the map has no free cell: no beam clears"));
  EXPECT_EQ(Program(run + "look_around -o level").err, "");
  Write("sweep.yaml",
        "experiment: ./small.yaml\nset: {frames: 5}\naxes: {trajectory: [look_around, up]}\n");
  EXPECT_THAT(Program("sweep ./sweep.yaml -o swept").err,
              HasSubstr("sweep: 1 of 2 runs, the first with trajectory=up: the map has no free "
                        "cell\n"));
}

TEST_F(TruthPaths, AFilesPathThroughAWallIsWarnedOf) {
  // Upright, looking along +y: through the room's far wall, from y = 4 to 4.1.
  const std::string look = " -0.7071068 0 0 0.7071068\n";
  Write("inside.txt", "0 1.5 1.0 1.1" + look + "0.1 1.5 1.2 1.1" + look + "0.2 1.5 1.4 1.1" + look);
  Write("through.txt",
        "0 1.5 3.0 1.1" + look + "0.1 1.5 3.7 1.1" + look + "0.2 1.5 4.3 1.1" + look);
  Write("near.txt", "0 1.5 3.0 1.1" + look + "0.1 1.5 3.97 1.1" + look);
  const auto said = [&](const std::string& command, const std::string& file) {
    const Outcome outcome =
        Program(command + " ./small.yaml --force -o out_" + command.substr(0, 3) +
                " --set frames=0 --set trajectory=./" + file);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  };
  for (const char* command : {"run", "render --no-colour", "ablate"}) {
    const std::string with = std::string(command) + " ./small.yaml -o new --set trajectory=./";
    ExpectRefusal(with + "near.txt",
                  {"small.yaml:", ": frames is 12, must be at most the 2 poses of "});
    ExpectRefusal(with + "near.txt --set frames=3",
                  {"depthgrid: --set frames=3: frames is 3, must be at most the 2 poses of "});
  }
  Write("beside.txt", "0 9 3.0 1.1" + look + "0.1 9 3.2 1.1" + look);
  EXPECT_EQ(said("run", "inside.txt"), "");
  EXPECT_THAT(said("run", "beside.txt"),
              HasSubstr("beside.txt: frame 0 at (9.00, 3.00, 1.10) is outside the scene"));
  for (const char* command : {"run", "render --no-colour", "ablate --seeds 1"}) {
    EXPECT_THAT(
        said(command, "through.txt"),
        AllOf(HasSubstr("depthgrid: warning: /"),
              HasSubstr("through.txt: frame 2 at (1.50, 4.30, 1.10) is 0.200 m from geometry"),
              HasSubstr("the path goes through it\n")));
    EXPECT_THAT(said(command, "near.txt"),
                HasSubstr("near.txt: frame 1 at (1.50, 3.97, 1.10) is 0.030 m from geometry"));
  }
  Write("sweep.yaml",
        "experiment: ./small.yaml\nset: {frames: 0}\naxes:\n"
        "  trajectory: [./inside.txt, ./near.txt]\n  mapper.fusion.gain: [0, 1]\n");
  const Outcome sweep = Program("sweep ./sweep.yaml --dry-run -o sweep");
  EXPECT_EQ(sweep.exit_code, 0) << sweep.err;
  const std::size_t once = sweep.err.find("near.txt: frame 1 at (1.50, 3.97, 1.10) is 0.030 m");
  ASSERT_NE(once, std::string::npos) << sweep.err;
  EXPECT_EQ(sweep.err.find("near.txt", once + 1), std::string::npos);
  EXPECT_EQ(sweep.err.find("inside.txt"), std::string::npos);
}

// A file's path stays when the room is chosen anew, and may have changed since.
TEST_F(TruthPaths, AFilesPathIsComparedInAnotherRoomToo) {
  const std::string look = " -0.7071068 0 0 0.7071068\n";
  const std::string path = "0 1.5 1.0 1.1" + look + "0.1 1.5 1.2 1.1" + look;
  Write("path.txt", path);
  std::filesystem::copy_file(Path("room.yaml"), Path("other.yaml"));
  Succeed("run ./small.yaml --set frames=0 --set trajectory=./path.txt -o out");
  const std::string command = "run out/run.yaml --set scene=./other.yaml --force -o again";
  EXPECT_EQ(Program(command).err, "");
  Write("path.txt", path + "0.2 1.5 1.3 1.1" + look);
  EXPECT_THAT(Program(command).err,
              AllOf(HasSubstr("out/run.yaml: trajectory_hash is "), HasSubstr("path.txt is ")));
  EXPECT_EQ(Program(command + " --set trajectory=./path.txt").err, "");
}

}  // namespace
}  // namespace depthgrid
