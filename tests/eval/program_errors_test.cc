// Bad input of every kind: one clear line, exit code 2, and nothing left behind.
#include <gmock/gmock.h>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class ProgramErrors : public ProgramTest {};

TEST_F(ProgramErrors, WrongKeysNameTheNearestRightOne) {
  Write("wrong.yaml", std::string(kExperiment) + "framse: 3\n");
  ExpectRefusal("run ./wrong.yaml -o out", {"wrong.yaml:7", "'framse'", "'frames'"});
  Write("nested.yaml", "scene: ./room.yaml\nmapper: {fusion: {gian: 0.5}}\n");
  ExpectRefusal("run ./nested.yaml -o out",
                {"nested.yaml:2", "'mapper.fusion.gian'", "'mapper.fusion.gain'"});
  ExpectRefusal("run ./small.yaml --set mapper.fusoin.gain=1 -o out",
                {"'mapper.fusoin'", "'mapper.fusion'"});
  ExpectRefusal("render ./room.yaml --set sensr.noise=none -o out", {"'sensr'", "'sensor'"});
  ExpectRefusal("map . --poses x --set mapper.methd=paper -o out", {"'mapper.method'"});
}

TEST_F(ProgramErrors, ValuesOutOfRangeOrOfTheWrongKind) {
  ExpectRefusal("run ./small.yaml --set mapper.fusion.gain=1.5 -o out",
                {"--set mapper.fusion.gain=1.5:", "from 0 to 1"});
  ExpectRefusal("run ./small.yaml --set frames=-3 -o out", {"frames", "-3"});
  ExpectRefusal("run ./small.yaml --set frames=many -o out", {"frames", "many", "whole number"});
  ExpectRefusal("run ./small.yaml --set sensor.noise=hnada -o out", {"'handa'"});
  ExpectRefusal("run ./small.yaml --set frames -o out", {"key.path=value"});
  ExpectRefusal("run ./small.yaml --set mapper=3 -o out", {"mapper", "map of keys"});
}

TEST_F(ProgramErrors, MissingAndEmptyFiles) {
  ExpectRefusal("run ./nothing.yaml -o out", {"nothing.yaml", "no such file"});
  Write("empty.yaml", "");
  ExpectRefusal("run ./empty.yaml -o out", {"empty.yaml", "is empty"});
  Write("comment.yaml", "# nothing\n");
  ExpectRefusal("run ./comment.yaml -o out", {"comment.yaml", "is empty"});
  ExpectRefusal("render ./empty.yaml -o out", {"empty.yaml", "is empty"});
  Write("broken.yaml", "scene: [1\n");
  ExpectRefusal("run ./broken.yaml -o out", {"broken.yaml", "YAML"});
  Write("no_scene.yaml", "frames: 3\n");
  ExpectRefusal("run ./no_scene.yaml -o out", {"no_scene.yaml", "'scene'"});
  ExpectRefusal("run living_rom -o out", {"living_rom", "'living_room'"});
  ExpectRefusal("run ./small.yaml --set scene=office_rom -o out", {"'office_room'"});
  ExpectRefusal("map nowhere --poses x -o out", {"nowhere"});
  ExpectRefusal("map '' -o out", {"input: is empty"});
  ExpectRefusal("eval map '' map.yaml", {"is empty"});
  for (const std::string option : {"--poses", "--map", "--video"}) {
    ExpectRefusal("map . -o out " + option + " ''", {option + ": is empty"});
  }
  ExpectRefusal("report nowhere", {"nowhere"});
  ExpectRefusal("regrid . --resolution 0.05", {"run.yaml"});
}

TEST_F(ProgramErrors, ASceneOrATrajectoryThatIsNotThereIsNamedByItsLine) {
  Write("no_room.yaml", "frames: 3\nscene: living_rom\n");
  ExpectRefusal("run ./no_room.yaml -o out", {"no_room.yaml:2: ", "'living_room'"});
  ExpectRefusal("run ./small.yaml --set scene=office_rom -o out", {"--set scene=office_rom: "});
  Write("folder.yaml", "frames: 3\nscene: ./\n");
  ExpectRefusal("run ./folder.yaml -o out", {"folder.yaml:2: ", "is a folder, must be a scene"});
  Write("no_path.yaml", "scene: living_room\nframes: 3\ntrajectory: handhel\n");
  ExpectRefusal("run ./no_path.yaml -o out",
                {"no_path.yaml:3: trajectory is 'handhel'", "'handheld'"});
  ExpectRefusal("run living_room --set trajectory=up -o out",
                {"--set trajectory=up: trajectory is 'up', must be one of handheld, robot"});
  Write("rooms_sweep.yaml", "experiment: living_room\naxes:\n  scene: [living_room, offce]\n");
  ExpectRefusal("sweep ./rooms_sweep.yaml -o out", {"rooms_sweep.yaml:3: offce: no shipped scene"});
}

TEST_F(ProgramErrors, ATrajectoryFileThatIsNotThereIsNamedByItsLine) {
  Write("no_file.yaml", "scene: ./room.yaml\ntrajectory: ./nix.txt\n");
  ExpectRefusal("run ./no_file.yaml -o out", {"no_file.yaml:2: /", "/nix.txt: no such file"});
  ExpectRefusal("render ./no_file.yaml -o out", {"no_file.yaml:2: /"});
  ExpectRefusal("run ./small.yaml -o out --set trajectory=./nix.txt",
                {"depthgrid: --set trajectory=/", "/nix.txt: no such file"});
}

TEST_F(ProgramErrors, MapsAreNamedByTheirYamlFile) {
  Write("map.yaml", "image: gone.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n");
  ExpectRefusal("eval map map.yaml map.yaml", {"map.yaml: image is 'gone.pgm': no such file"});
  Write("map.pgm", "P5 1 1 255\n0");
  ExpectRefusal("eval map map.pgm map.yaml", {"map.pgm: is a map's image", "YAML"});
}

TEST_F(ProgramErrors, AMapOfOtherCellsCanBeDrawnAgain) {
  Succeed("run ./small.yaml -o 'a run'");
  Succeed("regrid 'a run' --resolution 0.02");
  ExpectRefusal(
      "eval map 'a run/truth_map.yaml' 'a run/map_0.02.yaml'",
      {"resolution is 0.02, must be the 0.05 of a run/truth_map.yaml, a whole multiple or "
       "a whole part of it; `depthgrid regrid 'a run' --resolution 0.05` draws it so"});
  Succeed("regrid 'a run' --resolution 0.05");
  Succeed("eval map 'a run/truth_map.yaml' 'a run/map_0.05.yaml'");
  std::filesystem::copy(Path("a run/map_0.02.yaml"), Path("map_0.02.yaml"));
  std::filesystem::copy(Path("a run/map_0.02.pgm"), Path("map_0.02.pgm"));
  ExpectRefusal(
      "eval map 'a run/truth_map.yaml' map_0.02.yaml",
      {"must be the 0.05 of a run/truth_map.yaml, a whole multiple or a whole part of it\n"});
}

TEST_F(ProgramErrors, QuotedBytesOfADamagedFileStayReadable) {
  Write("noise.txt", "\x07\x1b\xb7\xff 2 3 4 5 6 7 8\n");
  ExpectRefusal("eval trajectory noise.txt noise.txt", {"noise.txt:1: '?\?\?\?' is not a number"});
}

TEST_F(ProgramErrors, ScenesThatCannotBeUsed) {
  Write("empty_scene.yaml", "name: void\nshapes: []\n");
  ExpectRefusal("render ./empty_scene.yaml -o out", {"empty_scene.yaml"});
  Write("broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n");
  ExpectRefusal("render ./broken.ply -o out", {"broken.ply"});
  Write("noise.obj", "v 1 2\nf 1 2 3\n");
  ExpectRefusal("render ./noise.obj -o out", {"noise.obj"});
  Write("no_floor.yaml",
        "shapes:\n  - {shape: wall, from: [0, 0], to: [3, 0]}\n"
        "  - {shape: wall, from: [3, 0], to: [3, 4]}\n  - {shape: wall, from: [3, 4], to: [0, 4]}\n"
        "trajectories:\n  t: {kind: planar, waypoints: [{at: [1, 1]}, {at: [2, 1]}]}\n");
  ExpectRefusal("render ./no_floor.yaml -o out", {"no_floor.yaml", "floor"});
}

TEST_F(ProgramErrors, TrajectoriesThatDoNotFit) {
  ExpectRefusal("run ./small.yaml --set trajectory=look_arund -o out", {"'look_around'"});
  ExpectRefusal("run ./small.yaml --set trajectory=./nothing.txt -o out", {"nothing.txt"});
  std::string through_wall = kRoom;
  through_wall.replace(through_wall.find("[1.9, 2.0, 1.1]"), 15, "[0.4, 2.0, 1.1]");
  Write("room.yaml", through_wall);
  ExpectRefusal("run ./small.yaml --set frames=0 -o out", {"look_around", "from geometry"});
}

TEST_F(ProgramErrors, TrajectoriesThatShareNoStamp) {
  Write("a.txt", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  Write("b.txt", "11 0 0 0 0 0 0 1\n12 1 0 0 0 0 0 1\n");
  ExpectRefusal("eval trajectory a.txt b.txt", {"b.txt", "a.txt", "stamp"});
  Write("bad.txt", "1 0 0 zero 0 0 0 1\n");
  ExpectRefusal("eval trajectory a.txt bad.txt", {"bad.txt:1"});
  Write("none.txt", "# stamp tx ty tz qx qy qz qw\n");
  ExpectRefusal("eval trajectory a.txt none.txt", {"none.txt"});
  Succeed("render ./small.yaml --no-colour -o seq");
  ExpectRefusal("map seq --poses b.txt -o out", {"pose"});
  ExpectRefusal("map seq --loops a.txt -o out", {"--poses", "a.txt"});
  std::filesystem::remove(Path("seq/groundtruth.txt"));
  ExpectRefusal("map seq -o out", {"needs poses", "--poses FILE"});
}

TEST_F(ProgramErrors, ColumnsOfASpreadsheetAreNamed) {
  Write("a.txt", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  Write("semicolons.txt", "# t x y z\n1.0;0;0;0;0;0;0;1\n2.0;1;0;0;0;0;0;1\n");
  Write("commas.txt", "1,0 0,0 0,0 0,0 0,0 0,0 0,0 1,0\n2,0 0,5 0,0 0,0 0,0 0,0 0,0 1,0\n");
  Succeed("render ./small.yaml --no-colour -o seq");
  for (const char* command : {"eval trajectory a.txt ", "map seq -o out --poses "}) {
    ExpectRefusal(command + std::string("semicolons.txt"),
                  {"depthgrid: semicolons.txt:2: has semicolons between its columns"});
    ExpectRefusal(command + std::string("commas.txt"),
                  {"depthgrid: commas.txt:1: has decimal commas, must have decimal points"});
  }
}

TEST_F(ProgramErrors, BadUsage) {
  ExpectRefusal("", {"--help"});
  ExpectRefusal("rnu ./small.yaml -o out", {"'rnu'", "'run'", "--help"});
  ExpectRefusal("eval mpa a b", {"'mpa'", "'map'", "depthgrid eval --help"});
  ExpectRefusal("run ./small.yaml", {"--output"});
  ExpectRefusal("run ./small.yaml -o out --thread 3", {"'--thread'", "'--threads'", "run --help"});
  ExpectRefusal("run ./small.yaml more -o out", {"'more'"});
  ExpectRefusal("run ./small.yaml -o out --threads=-1", {"--threads"});
  ExpectRefusal("eval", {"--help"});
}

TEST_F(ProgramErrors, AKeyTakenForAnOptionIsSaidToBeOne) {
  ExpectRefusal("run ./small.yaml -o out --frames 30",
                {"no option '--frames': frames is a key, --set frames=30 (see depthgrid run"});
  ExpectRefusal("run ./small.yaml -o out --gain=0.3", {"--set mapper.fusion.gain=0.3 "});
  ExpectRefusal("map seq -o out --mapper.fusion.gain", {"--set mapper.fusion.gain=VALUE "});
  ExpectRefusal("map seq -o out --frames 30", {"no option '--frames' (see"});
  ExpectRefusal("map seq -o out --formats tum",
                {"no option '--formats', did you mean '--format'?"});
  ExpectRefusal("sweep ./small.yaml -o out --workers 2", {"no option '--workers' (see"});
  ExpectRefusal("ablate ./small.yaml -o out --use --json",
                {"no option '--use'"});  // of many groups
  ExpectRefusal("slam seq -o out --frames 30", {"no option '--frames'"});
  for (const char* key : {"slam_seed", "seed"}) {
    const std::string setting = std::string("--set ") + key + "=4";
    ExpectRefusal("slam seq -o out " + setting, {setting + ": give --seed N"});
  }
}

TEST_F(ProgramErrors, AKeyInTheWrongGroupNamesTheRightOne) {
  ExpectRefusal("run ./small.yaml -o out --set mapper.map.resolution=0.1",
                {"unknown key 'mapper.map', did you mean 'mapper.grid.resolution_m'"});
  ExpectRefusal("slam . -o out --set profile=planar_slam",
                {"unknown key 'profile', did you mean 'slam.profile'?"});
  ExpectRefusal("slam . -o out --set drift_scale=3",
                {"unknown key 'drift_scale', did you mean 'slam.drift_scale'?"});
}

TEST_F(ProgramErrors, ASlipInARequiredKeyOfASweepIsFound) {
  Write("many.yaml", "experiment: ./small.yaml\naxis: {seed: [1, 2]}\n");
  ExpectRefusal("sweep ./many.yaml -o out",
                {"many.yaml:2: unknown key 'axis', did you mean 'axes'?"});
  Write("many.yaml", "experimnet: ./small.yaml\naxes: {seed: [1, 2]}\n");
  ExpectRefusal("sweep ./many.yaml -o out",
                {"unknown key 'experimnet', did you mean 'experiment'?"});
}

TEST_F(ProgramErrors, AnExperimentsKeyInASweepIsToldItsPlace) {
  const std::string sweep = "experiment: ./small.yaml\naxes: {seed: [1, 2]}\n";
  Write("many.yaml", sweep + "sensor: {width: 320}\n");
  ExpectRefusal("sweep ./many.yaml -o out",
                {"many.yaml:3: 'sensor' is a key of the experiment, in a sweep it stands in 'set': "
                 "set: {sensor.KEY: ...}\n"});
  Write("many.yaml", sweep + "frames: 3\n");
  ExpectRefusal("sweep ./many.yaml -o out", {"many.yaml:3: 'frames'", "set: {frames: ...}\n"});
}

TEST_F(ProgramErrors, SettingsThatContradictEachOther) {
  for (const char* command : {"run", "render"}) {
    ExpectRefusal(std::string(command) + " ./small.yaml --set mapper.scan.band_low_m=10 -o out",
                  {"mapper.scan.band_low_m", "band_high_m"});
    ExpectRefusal(std::string(command) + " ./small.yaml --set mapper.scan.max_range_m=0.1 -o out",
                  {"mapper.scan.min_range_m", "max_range_m"});
    // So far below the image that no ray is left.
    ExpectRefusal(std::string(command) + " ./small.yaml --set sensor.cy=20000 -o out",
                  {"--set sensor.cy=20000: sensor: cy is 20000, must be within ten focal lengths"});
    ExpectRefusal(
        std::string(command) +
            " ./small.yaml --set sensor.min_range_m=30 --set sensor.max_range_m=20 -o out",
        {"--set sensor.min_range_m=30: sensor.min_range_m is 30, must be below max_ra"});
  }
  // Of two keys it is the one that was set that is at fault.
  Write("low.yaml", "scene: ./room.yaml\nmapper:\n  scan: {band_high_m: 0.1}\n");
  ExpectRefusal("run ./low.yaml -o out", {"low.yaml:3: mapper.scan.band_low_m is 0.1, must be"});
}

TEST_F(ProgramErrors, AnExperimentIsNeitherASceneNorAMesh) {
  Write("cube.ply", "ply\n");
  ExpectRefusal("run ./room.yaml -o out", {"room.yaml", "is a scene"});
  ExpectRefusal("run ./cube.ply -o out", {"cube.ply", "is a mesh"});
  ExpectRefusal("ablate ./room.yaml -o out", {"room.yaml", "is a scene"});
  Write("many.yaml", "experiment: ./small.yaml\naxes: {seed: [1, 2]}\n");
  ExpectRefusal("run ./many.yaml -o out", {"many.yaml", "is a sweep", "depthgrid sweep"});
  std::filesystem::create_directory(Path("done"));
  Write("done/run.yaml", "");
  for (const std::string name : {"./done", "done"}) {
    ExpectRefusal("run " + name + " -o out", {name + ": is a folder; the run.yaml in it can be"});
  }
}

TEST_F(ProgramErrors, ASweepsCacheIsRefusedBeforeItStarts) {
  Write("sweep.yaml", "experiment: ./small.yaml\naxes: {seed: [1, 2]}\n");
  ExpectRefusal("sweep ./sweep.yaml -o out --cache room.yaml", {"cannot be used as a cache"});
}

TEST_F(ProgramErrors, WhatCannotBePrintedIsAFailure) {
  // Half a table would be taken for a whole one.
  Write("way.txt", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 2 0 0 0 0 0 1\n");
  for (const char* arguments :
       {"scenes", "--help", "--version", "run --help", "run --keys", "sweep --keys", "map --keys",
        "eval trajectory way.txt way.txt", "eval trajectory way.txt way.txt --json"}) {
    const std::string command = "cd '" + root_.string() + "' && '" + kProgramFile + "' " +
                                arguments + " >/dev/full 2>full.txt";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1) << arguments;
    EXPECT_EQ(ReadFile(Path("full.txt")),
              "depthgrid: standard output: cannot be written: No space left on device\n")
        << arguments;
  }
}

TEST_F(ProgramErrors, AComplaintThatCannotBeWrittenChangesNothingElse) {
  const auto exit_code = [&](const std::string& arguments) {
    const std::string command = "cd '" + root_.string() + "' && '" + kProgramFile + "' " +
                                arguments + " >'" + Path("said.txt") + "' 2>/dev/full";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  EXPECT_EQ(exit_code("run ./nothing.yaml -o out"), 2);
  const std::string warned =
      "run ./small.yaml --set sensor.noise_scale=2 --set sensor.noise=none -o ";
  ASSERT_THAT(Program(warned + "heard").err, HasSubstr("warning"));
  EXPECT_EQ(exit_code(warned + "unheard"), 0);
  ExpectSameBytes("heard", "unheard");
}

TEST_F(ProgramErrors, ClosedStreamsAreNotTakenForFiles) {
  const std::string command = "cd '" + root_.string() + "' && '" + kProgramFile +
                              "' run ./small.yaml -o closed <&- >&- 2>&-";
  EXPECT_EQ(std::system(command.c_str()), 0);
  Succeed("run ./small.yaml -o open");
  ExpectSameBytes("open", "closed");
}

TEST_F(ProgramErrors, OptionsAreNamedAsTheyWereGiven) {
  Write("log.txt", "FLASER 2 1 1 0 0 0 0 0 0 1 host 1\n");
  ExpectRefusal("map log.txt --format kitti -o out", {"--format kitti: ", "carmen"});
  ExpectRefusal("map log.txt --up w -o out", {"--up w: ", "auto"});
  ExpectRefusal("map . --format carmen -o out", {".: is a folder"});
  Succeed("render ./small.yaml --no-colour -o seq");
  EXPECT_EQ(Program("map seq --camera nope.yaml -o out").err,
            "depthgrid: nope.yaml: no such file\n");
  ExpectRefusal("slam . --profile orb -o out", {"--profile orb: ", "orb_slam2"});
  // CLI11's own words for these are 300 digits long.
  for (const char* resolution : {"0", "0.001", "2", "fine"}) {
    ExpectRefusal(std::string("regrid . --resolution ") + resolution,
                  {std::string("--resolution ") + resolution + ": resolution_m is "});
  }
  ExpectRefusal("regrid . --resolution 0", {"must be from 0.005 to 1"});
  ExpectRefusal("eval trajectory a b --max-difference=-1",
                {"is '-1', must be a number, 0 or more"});
  ExpectRefusal("eval trajectory a b --time-offset nan",
                {"--time-offset: is 'nan', must be a number"});
}

TEST_F(ProgramErrors, AShippedNameOfAnotherKindIsSaidToBeOne) {
  EXPECT_EQ(Program("sweep living_room -o out").err,
            "depthgrid: living_room: is a shipped experiment, no sweep; see `depthgrid scenes`\n");
  EXPECT_EQ(Program("run kalman_gain -o out").err,
            "depthgrid: kalman_gain: is a shipped sweep, no experiment; see `depthgrid scenes`\n");
  EXPECT_EQ(Program("run living_rom -o out").err,
            "depthgrid: living_rom: no shipped experiment has this name, did you mean "
            "'living_room'?\n");
}

TEST_F(ProgramErrors, AProgramWithoutWhatIsShippedSaysSo) {
  std::filesystem::create_directories(Path("copy/bin"));
  std::filesystem::copy_file(kProgramFile, Path("copy/bin/depthgrid"));
  for (const char* arguments : {"scenes", "run living_room -o out", "render living_room -o out"}) {
    const std::string command =
        "cd '" + root_.string() + "' && copy/bin/depthgrid " + arguments + " >said.txt 2>&1";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2) << arguments;
    EXPECT_THAT(ReadFile(Path("said.txt")),
                HasSubstr("copy/share/depthgrid/scenes: the shipped scenes were not found"))
        << arguments;
  }
  const std::string own = "cd '" + root_.string() +
                          "' && copy/bin/depthgrid render ./room.yaml --no-colour --set frames=1 "
                          "--set sensor.width=80 --set sensor.height=60 -o out >said.txt 2>&1";
  EXPECT_EQ(std::system(own.c_str()), 0) << ReadFile(Path("said.txt"));
}

TEST_F(ProgramErrors, ImagesThatCannotBeDrawnAreRefusedAtOnce) {
  ExpectRefusal("run ./small.yaml --set sensor.width=8193 -o out",
                {"sensor.width is '8193', must be from 0 to 8192"});
}

// Scores of zero would be taken for those of a bad map.
TEST_F(ProgramErrors, MapsOfOtherPlacesAreWarnedOf) {
  const auto map = [&](const std::string& name, const std::string& x) {
    Write(name + ".yaml", "image: " + name + ".pgm\nresolution: 0.05\norigin: [" + x +
                              ", 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.196\nnegate: 0\n");
    Write(name + ".pgm", std::string("P5 3 2 255\n\xfe\xfe\xfe\x00\x00\x00", 17));
  };
  map("a", "0");
  map("b", "10");
  const auto warnings = [&](const std::string& arguments) {
    const Outcome outcome = Program("eval map " + arguments);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.out, HasSubstr("all, 1 cell tolerance"));
    return outcome.err;
  };
  EXPECT_EQ(warnings("a.yaml a.yaml --observable a.yaml"), "");
  EXPECT_THAT(warnings("a.yaml b.yaml"), HasSubstr("b.yaml: shares no known cell with a.yaml"));
  EXPECT_THAT(warnings("a.yaml a.yaml --observable b.yaml"),
              HasSubstr("b.yaml: of the cells that could be seen, a.yaml does not know 100 %"));
  map("utm", "500000");
  map("south", "-10000000");
  ExpectRefusal("eval map utm.yaml south.yaml",
                {"south.yaml: its lower left corner (-1e+07, 0) lies 10500000 m from"});
  ExpectRefusal(
      "eval map a.yaml a.yaml --observable utm.yaml",
      {"utm.yaml: its lower left corner (500000, 0) lies 500000 m from (0, 0), that of a.yaml"});
}

TEST_F(ProgramErrors, SeedsAreWholeNumbers) {
  for (const std::string seed : {"-3", "1.5", "nan", "abc", "99999999999999999999", "''"}) {
    for (const char* command : {"slam seq -o out --seed", "ablate ./small.yaml -o out --first-seed",
                                "slam-calibrate ./small.yaml --target 0.1 --first-seed"}) {
      ExpectRefusal(std::string(command) + " " + seed, {"seed", "from 0 to 18446744073709551615"});
    }
    ExpectRefusal("run ./small.yaml -o out --set seed=" + seed,
                  {"seed", "whole number from 0 to 18446744073709551615"});
  }
}

TEST_F(ProgramErrors, AFolderThatIsNotEmptyStaysAsItIs) {
  std::filesystem::create_directory(Path("mine"));
  Write("mine/map.pgm", "precious");
  for (const char* command : {"run ./small.yaml -o mine", "render ./small.yaml -o mine"}) {
    ExpectRefusal(command, {"mine", "--force"});
  }
  ExpectRefusal("run ./small.yaml -o small.yaml --force", {"small.yaml", "file"});
  EXPECT_EQ(ReadFile(Path("mine/map.pgm")), "precious");
}

}  // namespace
}  // namespace depthgrid
