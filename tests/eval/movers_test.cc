// What moves in a scene, from its file to the maps.
#include <set>
#include <sstream>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using testing::HasSubstr;
using testing::Not;

class Movers : public ProgramTest {
 protected:
  // Crosses the view behind the path, which lies beyond y = 1.
  static constexpr const char* kMovers = R"(
movers:
  visitor:
    shapes: [{shape: cylinder, radius_m: 0.2, height_m: 1.7}]
    there_and_back: true
    waypoints: [{at: [0.4, 3.4]}, {at: [2.6, 3.4]}]
  guide:
    shapes: [{shape: cylinder, radius_m: 0.15, height_m: 1.7}]
    ahead_m: 0.9
)";

  // Those of a column.
  static std::set<std::string> Values(const std::string& table, const std::string& column) {
    std::set<std::string> values;
    std::size_t at = 0;
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);) {
      std::vector<std::string> fields;
      std::istringstream parts(line);
      for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
      if (line.starts_with("run,")) {
        const auto found = std::find(fields.begin(), fields.end(), column);
        at = static_cast<std::size_t>(found - fields.begin());
      } else if (at < fields.size()) {
        values.insert(fields[at]);
      }
    }
    return values;
  }

  void SetUp() override {
    ProgramTest::SetUp();
    Write("peopled.yaml", std::string(kRoom) + kMovers);
  }
  std::vector<std::string> DepthFilesIn(const std::string& folder) const {
    std::vector<std::string> files = FilesIn(folder);
    std::erase_if(files, [](const std::string& file) { return !file.ends_with(".depth"); });
    return files;
  }
  void AddMovers() const { Write("room.yaml", std::string(kRoom) + kMovers); }
};

// In the next room, whose wall hides it, or behind the camera's back.
TEST_F(Movers, ThatAreNeverSeenAreSaid) {
  Write("room.yaml", std::string(kRoom) + kMovers + R"(
  neighbour:
    shapes: [{shape: cylinder, radius_m: 0.2, height_m: 1.7}]
    there_and_back: true
    waypoints: [{at: [0.4, 9.4]}, {at: [2.6, 9.4]}]
)");
  const char* said = "movers: neighbour: no frame of this path shows it\n";
  EXPECT_THAT(Program("run ./small.yaml -o out --no-cache --set movers=visitor+neighbour").err,
              HasSubstr(said));
  EXPECT_THAT(ReadFile(Path("out/warnings.txt")), HasSubstr(said));
  for (const char* seen : {"visitor", "guide", "all", "guide+visitor"}) {
    EXPECT_THAT(
        Program(std::string("run ./small.yaml -o out --force --no-cache --set movers=") + seen).err,
        Not(HasSubstr("no frame")))
        << seen;
  }
}

TEST_F(Movers, AreThereOnlyWhereTheExperimentNamesThem) {
  Succeed("run ./small.yaml -o before --no-cache");
  AddMovers();
  Succeed("run ./small.yaml -o without --no-cache");
  ExpectSameBytes("before", "without");
  Succeed("run ./small.yaml -o all --no-cache --set movers=all");
  Succeed("run ./small.yaml -o both --no-cache --set movers=guide+visitor");
  Succeed("run ./small.yaml -o visitor --no-cache --set movers=visitor");
  EXPECT_TRUE(SameFile("all/map.pgm", "both/map.pgm"));
  EXPECT_FALSE(SameFile("all/scans.bin", "without/scans.bin"));
  EXPECT_FALSE(SameFile("all/scans.bin", "visitor/scans.bin"));
  EXPECT_FALSE(SameFile("visitor/scans.bin", "without/scans.bin"));
  // Both cameras see them.
  for (const std::string& file : FilesIn("all/frames")) {
    EXPECT_FALSE(SameFile("all/frames/" + file, "without/frames/" + file)) << file;
  }
  // The truth is of what stands.
  for (const char* file : {"truth_map.pgm", "observable.pgm", "trajectory_truth.txt"}) {
    EXPECT_TRUE(SameFile(std::string("all/") + file, std::string("without/") + file)) << file;
  }
  // Which movers there are is of the scene, as the runs say.
  const auto line = [&](const std::string& run, const std::string& key) {
    const std::string yaml = ReadFile(Path(run + "/run.yaml"));
    const std::size_t at = yaml.find(key);
    return yaml.substr(at, yaml.find('\n', at) - at);
  };
  EXPECT_EQ(line("visitor", "movers"), "movers: visitor");
  EXPECT_NE(line("visitor", "scene_hash"), line("without", "scene_hash"));
  EXPECT_NE(line("visitor", "scene_hash"), line("all", "scene_hash"));
  EXPECT_THAT(ReadFile(Path("visitor/report.html")), HasSubstr("movers visitor"));
}

TEST_F(Movers, AreTheSameWithAnyThreadsAndWithRoomsFromTheCache) {
  AddMovers();
  Succeed("run ./small.yaml -o one --threads 1 --no-cache --set movers=all");
  Succeed("run ./small.yaml -o three --threads 3 --no-cache --set movers=all");
  ExpectSameBytes("one", "three");
  Succeed("run ./small.yaml -o filling --cache cache");
  const auto cached = DepthFilesIn("cache");
  Succeed("run ./small.yaml -o cached --cache cache --set movers=all");
  ExpectSameBytes("one", "cached");
  EXPECT_EQ(DepthFilesIn("cache"), cached);  // the room was there
  EXPECT_EQ(cached.size(), 12U);
  Succeed("run ./small.yaml -o again --no-cache");
  ExpectSameBytes("filling", "again");
}

TEST_F(Movers, AreRendered) {
  AddMovers();
  Succeed("render ./small.yaml -o still --no-cache");
  Succeed("render ./small.yaml -o moving --no-cache --set movers=visitor");
  int compared = 0;
  for (const std::string& file : FilesIn("still")) {
    if (!file.ends_with(".png")) continue;
    EXPECT_FALSE(SameFile("still/" + file, "moving/" + file)) << file;
    ++compared;
  }
  EXPECT_EQ(compared, 24);
  EXPECT_TRUE(SameFile("still/truth_map.pgm", "moving/truth_map.pgm"));
}

TEST_F(Movers, OthersThanTheScenesAreRefused) {
  ExpectRefusal("run ./small.yaml -o out --set movers=all",
                {"movers is 'all', must be none: the scene has no movers"});
  AddMovers();
  ExpectRefusal(
      "run ./small.yaml -o out --set movers=visitr",
      {"--set movers=visitr: movers is 'visitr', must be one of visitor, guide, all, none, "
       "or names joined by +, did you mean 'visitor'?"});
  ExpectRefusal(
      "run ./small.yaml -o out --set movers=visitor+visitor",
      {"movers=visitor+visitor: movers is 'visitor+visitor', must name 'visitor' once (scene " +
       Path("room.yaml") + ")\n"});
  ExpectRefusal("run ./small.yaml -o out --set movers=guide+", {"movers is 'guide+'"});
  ExpectRefusal("run ./small.yaml -o out --set movers=guide+all", {"movers is 'guide+all'"});
  Write("moved.yaml", std::string(kExperiment) + "movers: nobody\n");
  ExpectRefusal("run ./moved.yaml -o out", {"moved.yaml:7: movers is 'nobody'"});
}

TEST_F(Movers, APathThatOneWalksIntoIsRefused) {
  const std::string guide = "    ahead_m: 0.9\n";
  std::string movers = kMovers;
  movers.replace(movers.find(guide), guide.size(), "    ahead_m: 0.3\n");
  Write("room.yaml", std::string(kRoom) + movers);
  ExpectRefusal("run ./small.yaml -o out --set movers=all",
                {"room.yaml:13: trajectory 'look_around': frame 0 at (1.50, 1.00, 1.10) is 0.15",
                 "m "
                 "from mover 'guide', must be at least 0.200 m"});
  Succeed("run ./small.yaml -o visitor --set movers=visitor");
  // A path from a file is warned of.
  Write("path.txt",
        "10 1.5 1 1.1 -0.7071068 0 0 0.7071068\n10.1 1.5 1 1.1 -0.7071068 0 0 "
        "0.7071068\n");
  movers.replace(movers.find("ahead_m: 0.3"), 12, "ahead_m: 0.1");
  Write("room.yaml", std::string(kRoom) + movers);
  const Outcome outcome = Program(
      "run ./small.yaml -o out --set frames=0 --set trajectory=./path.txt --set movers=guide");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("path.txt: frame 0 at (1.50, 1.00, 1.10) is 0.000 m from mover "
                        "'guide', must be at least 0.050 m"));
}

TEST_F(Movers, AreAnAxis) {
  AddMovers();
  Write("sweep.yaml",
        "experiment: ./small.yaml\naxes:\n  movers: [none, visitor, guide+visitor]\n  seed: [1, "
        "2]\n");
  Succeed("sweep ./sweep.yaml -o out");
  const std::string table = ReadFile(Path("out/results.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 7);
  EXPECT_THAT(table, HasSubstr("guide+visitor"));
  EXPECT_EQ(Values(table, "map.chamfer_m").size(), 6U);  // of six runs, all different
  // A mover that has changed makes it another sweep.
  std::string room = std::string(kRoom) + kMovers;
  room.replace(room.find("[2.6, 3.4]"), 10, "[2.5, 3.4]");
  Write("room.yaml", room);
  const Outcome changed = Program("sweep ./sweep.yaml -o out");
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_THAT(changed.err,
              HasSubstr("out: holds runs in a scene, path or movers that have changed"));
}

TEST_F(Movers, AreListedWithTheirScene) {
  const Outcome outcome = Program("scenes ./peopled.yaml --plan plan.png");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              testing::ContainsRegex("visitor +there and back +0 +4\\.4 m +6\\.7 s\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("guide +0\\.9 m ahead of the camera +0 +- +-\n"));
  EXPECT_THAT(outcome.out, HasSubstr("movers: all"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("refused")));
  Write("near.yaml",
        std::string(kRoom) + "movers:\n  cart:\n    shapes: [{shape: box}]\n    ahead_m: 0.6\n");
  EXPECT_THAT(Program("scenes ./near.yaml").out,
              testing::ContainsRegex("refused with movers: .*from mover 'cart'"));
  Succeed("scenes ./room.yaml --plan still.png");
  EXPECT_FALSE(SameFile("plan.png", "still.png"));
  EXPECT_THAT(Program("scenes ./room.yaml").out, Not(HasSubstr("mover")));
}

}  // namespace
}  // namespace depthgrid
