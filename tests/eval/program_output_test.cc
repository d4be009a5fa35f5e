// Where a command may put what it writes, said before any work, and finds what it reads.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class ProgramOutput : public ProgramTest {};

TEST_F(ProgramOutput, ThePageIsNamedAsAPath) {
  EXPECT_THAT(Program("run ./small.yaml --set frames=2 -o out/").out,
              HasSubstr("look at out/report.html\n"));
}

TEST_F(ProgramOutput, TheCurrentFolderIsNeverReplaced) {
  fs::create_directory(Path("here"));
  // In a folder below the test's, as a shell would be.
  const auto refusal = [&](const std::string& output) {
    const Outcome outcome = Program("render ../room.yaml --no-colour -o " + output, "cd here && ");
    EXPECT_EQ(outcome.exit_code, 2) << output;
    return outcome.err;
  };
  const std::string is = " is the current folder, must be a folder of its own\n";
  EXPECT_EQ(refusal("."), "depthgrid: -o: ." + is);
  EXPECT_EQ(refusal("./ --force"), "depthgrid: -o: ./" + is);
  EXPECT_EQ(refusal("../here"), "depthgrid: -o: ../here" + is);
  EXPECT_EQ(refusal(".. --force"),
            "depthgrid: -o: .. holds the current folder, must be a folder of its own\n");
  EXPECT_EQ(refusal("/"),
            "depthgrid: -o: / holds the current folder, must be a folder of its own\n");
  EXPECT_EQ(FilesIn(""), (std::vector<std::string>{"room.yaml", "small.yaml"}));
  EXPECT_TRUE(fs::is_empty(Path("here")));
  EXPECT_EQ(Program("render ../room.yaml --no-colour --set frames=2 -o ../here2", "cd here && ")
                .exit_code,
            0);
}

TEST_F(ProgramOutput, ALinkToNothingIsRefusedBeforeTheWork) {
  fs::create_symlink("gone", Path("link"));
  for (const char* command : {"run ./small.yaml", "render ./room.yaml", "sweep kalman_gain"}) {
    ExpectRefusal(std::string(command) + " -o link",
                  {"depthgrid: link: is a link to gone, which is not there"});
    ExpectRefusal(std::string(command) + " -o link/", {"link/: is a link to gone"});
  }
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_FALSE(fs::exists(Path(".link.partial")));
  fs::create_symlink("loop", Path("loop"));
  EXPECT_EQ(Program("run ./small.yaml -o loop").err,
            "depthgrid: loop: cannot be created: Too many levels of symbolic links\n");
}

TEST_F(ProgramOutput, AFolderThatMayNotBeEnteredIsNamedAsGiven) {
  fs::create_directories(Path("closed/full"));
  ASSERT_EQ(::chmod(Path("closed").c_str(), 0000), 0);
  // Root may go everywhere.
  const std::string nobody =
      ::geteuid() == 0 ? "setpriv --reuid=65534 --regid=65534 --clear-groups " : "";
  const bool runs = Program("--version", nobody).exit_code == 0;
  std::vector<std::pair<std::string, std::string>> said;
  for (const std::string command : {"run ./small.yaml", "map .", "sweep kalman_gain"}) {
    if (!runs) break;
    const Outcome below = Program(command + " -o closed/full", nobody);
    const Outcome itself = Program(command + " -o closed --force", nobody);
    said.emplace_back(below.err, itself.err);
    EXPECT_EQ(below.exit_code, 2);
    EXPECT_EQ(itself.exit_code, 2);
  }
  ASSERT_EQ(::chmod(Path("closed").c_str(), 0755), 0);
  if (!runs) GTEST_SKIP() << "no unprivileged user runs the program";
  for (const auto& [below, itself] : said) {
    EXPECT_EQ(below, "depthgrid: closed/full: cannot be created: Permission denied\n");
    EXPECT_EQ(itself, "depthgrid: closed: cannot be written: Permission denied\n");
  }
}

TEST_F(ProgramOutput, AFolderInOneThatMayNotBeWrittenIsWrittenInside) {
  const std::string nobody =
      ::geteuid() == 0 ? "env -u MESA_SHADER_CACHE_DIR "  // the tests' own, which is root's
                         "setpriv --reuid=65534 --regid=65534 --clear-groups "
                       : "";
  if (Program("--version", nobody).exit_code != 0) GTEST_SKIP() << "no unprivileged user runs it";
  fs::create_directories(Path("around/own"));
  ASSERT_EQ(::chmod(Path("around/own").c_str(), 0777), 0);
  ASSERT_EQ(::chmod(Path("around").c_str(), 0555), 0);
  const Outcome outcome =
      Program("run ./small.yaml --set frames=2 --no-cache -o around/own", nobody);
  ASSERT_EQ(::chmod(Path("around").c_str(), 0755), 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(fs::exists(Path("around/own/report.html")));
  EXPECT_FALSE(fs::exists(Path("around/own/.own.partial")));
}

TEST_F(ProgramOutput, AFolderIsWhatItsNameMeans) {
  const Outcome run = Program("run ./small.yaml --set frames=2 -o nothere/../out");
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, HasSubstr("look at out/report.html\n"));
  EXPECT_TRUE(fs::exists(Path("out/frames/000000_colour.png")));
  Write("s.yaml", "experiment: ./small.yaml\nset: {frames: 3}\naxes: {seed: [1]}\n");
  Succeed("sweep ./s.yaml -o nothere/../swept");
  EXPECT_TRUE(fs::exists(Path("swept/results.csv")));
  Succeed("report out -o nothere/../page");
  EXPECT_TRUE(fs::exists(Path("page/report.html")));
  EXPECT_FALSE(fs::exists(Path("nothere")));
}

TEST_F(ProgramOutput, ACacheInTheOutputIsRefusedBeforeTheWork) {
  Write("s.yaml", "experiment: ./small.yaml\nset: {frames: 3}\naxes: {seed: [1]}\n");
  for (const std::string command : {"sweep ./s.yaml", "run ./small.yaml", "ablate ./small.yaml"}) {
    for (const std::string cache : {"out", "out/cache", "out/a/../b"}) {
      ExpectRefusal(command + " -o out --cache " + cache,
                    {"--cache " + cache + ": is a place in out, the output, must be one beside"});
    }
  }
  Succeed("sweep ./s.yaml -o out --cache cache");
}

TEST_F(ProgramOutput, AVideoIsNotWhereTheFolderIs) {
  Write("one.log", "FLASER 3 2 2 2 1.5 -2 0.25 1.5 -2 0.25 10.5 host 10.5\n");
  for (const std::string output : {"x.mp4", "./x.mp4/", "x.mp4/below"}) {
    ExpectRefusal("map one.log --video x.mp4 -o " + output,
                  {"--video x.mp4: is where -o " + output + " makes a folder"});
  }
}

// A run.yaml names files, which may have changed since.
TEST_F(ProgramOutput, AChangedSceneOrPathIsSaidWhenARunIsMadeAgain) {
  Succeed("run ./small.yaml -o out");
  const auto hash = [&](const std::string& folder, const std::string& key) {
    const std::string text = ReadFile(Path(folder + "/run.yaml"));
    const std::size_t start = text.find("  " + key + ": ") + key.size() + 4;
    return text.substr(start, text.find('\n', start) - start);
  };
  const auto warning = [&](const std::string& key, const std::string& of) {
    return "depthgrid: warning: out/run.yaml: " + key + " is " + hash("out", key) +
           ", but that of " + of + Path("room.yaml") + " is " + hash("again", key) +
           " now: this run differs from the recorded one\n";
  };
  const std::string room = ReadFile(Path("room.yaml"));
  const auto again = [&](const std::string& from, const std::string& to) {
    std::string changed = room;
    Write("room.yaml", changed.replace(changed.find(from), from.size(), to));
    return Program("run out/run.yaml -o again --force").err;
  };
  const std::string of_path = again("[1.9, 2.0, 1.1]", "[1.9, 2.0, 1.2]");
  EXPECT_EQ(of_path, warning("trajectory_hash", "the path in "));
  EXPECT_EQ(hash("again", "scene_hash"), hash("out", "scene_hash"));
  EXPECT_EQ(ReadFile(Path("again/warnings.txt")).find("out/run.yaml: trajectory_hash is "), 0U);
  const std::string of_scene = again("[0.5, 0.5, 1.5]", "[0.5, 0.5, 1.4]");
  EXPECT_EQ(of_scene, warning("scene_hash", ""));
  EXPECT_EQ(hash("again", "trajectory_hash"), hash("out", "trajectory_hash"));
  EXPECT_THAT(Program("render out/run.yaml --no-colour -o seq").err, HasSubstr(of_scene));
  EXPECT_THAT(Program("slam-calibrate out/run.yaml --target 0.1 --seeds 2").err,
              HasSubstr(of_scene));
  Write("sweep.yaml", "experiment: out/run.yaml\naxes: {mapper.fusion.gain: [0, 1]}\n");
  EXPECT_THAT(Program("sweep ./sweep.yaml --dry-run -o sweep").err,
              HasSubstr(of_scene.substr(of_scene.find("out/run.yaml"))));
  // Somebody else's copy of the room has its name; another room is another run on purpose.
  fs::create_directories(Path("copy"));
  fs::copy_file(Path("room.yaml"), Path("copy/room.yaml"));
  fs::copy_file(Path("room.yaml"), Path("copy/hall.yaml"));
  EXPECT_THAT(Program("run out/run.yaml -o again --force --set scene=copy/room.yaml").err,
              HasSubstr("out/run.yaml: scene_hash is "));
  EXPECT_THAT(Program("run out/run.yaml -o again --force --set scene=copy/hall.yaml").err,
              Not(HasSubstr("scene_hash")));
  Write("rooms.yaml", "experiment: out/run.yaml\naxes: {scene: [" + Path("room.yaml") + "]}\n");
  EXPECT_EQ(Program("sweep ./rooms.yaml --dry-run -o sweep").err, "");
  EXPECT_EQ(Program("render ./room.yaml --no-colour -o scene --set frames=2").err, "");
  EXPECT_EQ(Program("run again/run.yaml -o third").err, "");  // it has the new hashes
  EXPECT_EQ(Program("run out/run.yaml -o other --set scene=./room.yaml").err, of_scene);
  Write("room.yaml", room);
  EXPECT_EQ(Program("run out/run.yaml -o fourth --set frames=11").err, "");
}

TEST_F(ProgramOutput, WhatCanBeDoneIsSaid) {
  ExpectRefusal("regrid nope --resolution 0.02", {"depthgrid: nope: no such folder\n"});
  ExpectRefusal("report nope", {"nope: "});
  Succeed("run ./small.yaml -o made");
  Succeed("regrid made --resolution 0.02");
  ExpectRefusal("regrid made --resolution 0.02",
                {"depthgrid: made/map_0.02.yaml: is there already; move it away, or --force to "
                 "replace it\n"});
  Succeed("regrid made --resolution 0.02 --force");
  Succeed("render ./small.yaml --no-colour --set frames=2 -o seq");
  ExpectRefusal("map seq --poses seq/groundtruth.txt --map nope -o out",
                {"depthgrid: nope: no such folder\n"});
}

// After the last frame of a long run the bar would stand full for a minute.
TEST_F(ProgramOutput, ATerminalIsToldThatTheMapIsBeingFinished) {
  const Outcome piped = Program("run ./small.yaml -o piped");
  EXPECT_EQ(piped.exit_code, 0);
  EXPECT_EQ(piped.err.find("finishing"), std::string::npos) << piped.err;
  const std::string on_terminal = "cd '" + root_.string() + "' && script -qec \"'" + kProgramFile +
                                  "' run ./small.yaml -o made\" typed </dev/null >/dev/null 2>&1";
  ASSERT_EQ(std::system(on_terminal.c_str()), 0);
  const std::string said = ReadFile(Path("typed"));
  const std::size_t finishing = said.find("finishing the map ...");
  EXPECT_LT(said.find("12/12"), finishing) << said;
  EXPECT_LT(finishing, said.find("writing the folder and the report ...")) << said;
}

TEST_F(ProgramOutput, AnExperimentsFilesAreFoundFromAnywhere) {
  const std::filesystem::path elsewhere = Path("else where");
  std::filesystem::create_directories(elsewhere / "rooms");
  std::filesystem::copy_file(Path("room.yaml"), elsewhere / "rooms/other.yaml");
  const auto from_elsewhere = [&](const std::string& arguments) {
    return Program(arguments, "cd '" + elsewhere.string() + "' && ");
  };
  EXPECT_EQ(from_elsewhere("run ../small.yaml -o out").err, "");
  EXPECT_EQ(from_elsewhere("run '" + Path("small.yaml") + "' -o out2").err, "");
  // What --set names is meant from where the user is.
  EXPECT_EQ(from_elsewhere("run ../small.yaml --set scene=rooms/other.yaml -o out3").err, "");
  EXPECT_THAT(ReadFile((elsewhere / "out3/run.yaml").string()), HasSubstr("rooms/other.yaml"));
  EXPECT_TRUE(SameFile("else where/out/map.pgm", "else where/out3/map.pgm"));
  EXPECT_TRUE(SameFile("else where/out/map.pgm", "else where/out2/map.pgm"));
}

// Intrinsics of 640 x 480 pixels beside a size of 80 x 60.
TEST_F(ProgramOutput, APrincipalPointBesideTheImageIsWarnedOf) {
  const auto said = [&](const std::string& set) {
    return Program("run ./small.yaml -o out --force --set frames=2" + set).err;
  };
  const std::string warning =
      "depthgrid: warning: the camera's principal point, sensor.cx 319.5 and cy 29.5, lies outside "
      "its image of 80 x 60 pixels: are they of another size?\n";
  EXPECT_THAT(said(" --set sensor.cx=319.5"), testing::StartsWith(warning));
  EXPECT_EQ(said(" --set sensor.cx=79.5"), "");
  EXPECT_EQ(Program("render ./small.yaml --no-colour -o seq --set sensor.cx=319.5").err, warning);
}

TEST_F(ProgramOutput, AnImageOfAnotherShapeThanItsCamerasIsWarnedOf) {
  const auto said = [&](const std::string& set) {
    return Program("render ./room.yaml --no-colour -o seq --force --set frames=2" + set).err;
  };
  EXPECT_EQ(
      said(" --set sensor.width=160"),
      "depthgrid: warning: sensor.width 160 and height 480 scale the camera's focal lengths "
      "to 120.3 and 480 pixels: scale both by one factor, or set sensor.hfov_deg, which makes "
      "square pixels\n");
  EXPECT_EQ(said(" --set sensor.width=160 --set sensor.height=120"), "");
  EXPECT_EQ(said(" --set sensor.width=160 --set sensor.hfov_deg=60"), "");
  EXPECT_EQ(
      said(" --set sensor.fx=300"),
      "depthgrid: warning: sensor.fx is 300 and fy 480, of which only fx was set: set both\n");
  EXPECT_EQ(said(" --set sensor.fx=300 --set sensor.fy=480"), "");
}

// Of the settings that images have, and of seeds; the others may be meant for what comes after.
TEST_F(ProgramOutput, RenderSaysWhatHasNoEffectOnImages) {
  const auto said = [&](const std::string& arguments) {
    return Program("render " + arguments + " --no-colour -o seq --force --set frames=2").err;
  };
  EXPECT_EQ(said("./room.yaml --set sensor.noise_scale=2 --set mapper.fusion.gain=1"),
            "depthgrid: warning: --set sensor.noise_scale=2: has no effect because sensor.noise is "
            "none\n");
  EXPECT_EQ(said("./room.yaml --set sensor.noise_scale=2 --set sensor.noise=d435"), "");
  EXPECT_EQ(said("./room.yaml --set slam_seed=2"),
            "depthgrid: warning: --set slam_seed=2: has no effect because slam.profile is "
            "ground_truth\n");
  EXPECT_EQ(said("./room.yaml --set slam_seed=2 --set slam.profile=orb_slam2"), "");
  Write("idle.yaml", "scene: room.yaml\nsensor: {grazing_limit_deg: 60}\n");
  EXPECT_EQ(said("./idle.yaml"),
            "depthgrid: warning: ./idle.yaml:2: sensor.grazing_limit_deg has no effect because "
            "sensor.noise is none\n");
}

// Behind "--" nothing is an option.
TEST_F(ProgramOutput, AFileMayBeginWithADash) {
  Write("-small.yaml", kExperiment);
  Succeed("run --set frames=2 -o one -- -small.yaml");
  Succeed("compare --metric all -- one one");
  ExpectRefusal("run -- -small.yaml -o out",
                {"'-o' is one argument too many: after -- nothing is an option (see depthgrid run "
                 "--help)"});
  ExpectRefusal("run -small.yaml -o out", {"no option '-s"});
  ExpectRefusal("first run one -o out", {"no command 'first' (see depthgrid --help)"});
  ExpectRefusal("first run -o out -- one", {"no command 'first' (see depthgrid --help)"});
  ExpectRefusal("eval map one two -- -x",
                {"'-x' is one argument too many: after -- nothing is an option (see depthgrid eval "
                 "map --help)"});
  ExpectRefusal("run -- -x", {"--output is required (see depthgrid run --help)"});
  for (const char* extra :
       {"run -o out -- -small.yaml -x", "run -small.yaml -o out -- -x", "run one -o out -- -x"}) {
    SCOPED_TRACE(extra);
    const bool unknown_first = std::string(extra).starts_with("run -small");
    ExpectRefusal(extra, {unknown_first ? "no option '-s"
                                        : "'-x' is one argument too many: after -- nothing is an "
                                          "option (see depthgrid run --help)"});
  }
}

TEST_F(ProgramOutput, RenderSaysThatNoImageShowsAnything) {
  const auto said = [&](const std::string& range_m) {
    return Program("render ./room.yaml --no-colour -o seq --force --set frames=2" + range_m).err;
  };
  EXPECT_EQ(said(" --set sensor.min_range_m=20 --set sensor.max_range_m=30"),
            "depthgrid: warning: no depth image shows anything: the camera sees no surface that is "
            "20 to 30 m away\n");
  EXPECT_EQ(said(""), "");
}

// Shells replace ~ only at the beginning of a word, so this would be a folder named ~ here.
TEST_F(ProgramOutput, ATildeThatTheShellHasLeftIsRefused) {
  const std::string says = "whose ~ the shell has left as it is: must be $HOME/td instead";
  for (const char* arguments :
       {"run ./small.yaml --output=~/td", "run ./small.yaml -o '~/td'", "map '~/td' -o out",
        "map . -o out --poses=~/td", "sweep ./sweep.yaml -o out --cache=~/td", "report '~/td'",
        "run ./small.yaml -o out --set scene=~/td", "run ./small.yaml -o '~/td/../x'",
        "eval trajectory a.txt b.txt --errors=~/td", "compare '~/td' b",
        "sweep ./sweep.yaml -o out --reuse=~/td", "scenes living_room --plan=~/td"}) {
    ExpectRefusal(arguments, {std::string(arguments).find("/../") == std::string::npos
                                  ? says
                                  : "must be $HOME/td/../x"});
  }
}

}  // namespace
}  // namespace depthgrid
