// Scenes and paths that are corrected after their runs have failed: the sweep goes on, but never
// with results of two rooms in one table.
#include <gmock/gmock.h>

#include "eval/sweep/sweep_database.h"
#include "tests/sweep/sweep_tables.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SweepCorrected : public SweepTableTest {
 protected:
  void SetUp() override {
    SweepTableTest::SetUp();
    Write("sound.yaml", kRoom);
    Write("walled.yaml", Walled());
    WriteRooms("");
  }
  void WriteRooms(const std::string& more) const {
    Write("rooms.yaml",
          "experiment: ./small.yaml\naxes:\n  scene: [./sound.yaml, ./walled.yaml]\n"
          "  seed: {seeds: 2}\n" +
              more);
  }
  // The path begins within the box.
  static std::string Walled() { return Replaced(kRoom, "[0.4, 2.0, 0]", "[1.5, 1.0, 0]"); }
  static std::string Replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  }
  // Another room, in which the same path is free.
  static std::string Moved() { return Replaced(kRoom, "[0.4, 2.0, 0]", "[0.4, 2.1, 0]"); }
  // One line, and nothing done.
  void ExpectNotGoneOn(const std::string& arguments, const std::string& says) const {
    const std::string table = ReadFile(Path("out/results.csv"));
    const Outcome outcome = Program(arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(says));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(ReadFile(Path("out/results.csv")), table);
  }
  std::size_t FailuresIn(const std::string& folder) const {
    const SweepResults results = ReadSweep(Path(folder));
    return static_cast<std::size_t>(
        std::count_if(results.failures.begin(), results.failures.end(),
                      [](const std::string& failure) { return !failure.empty(); }));
  }
};

TEST_F(SweepCorrected, GoesOnWhereEveryRunOfTheRoomHadFailed) {
  Succeed("sweep ./rooms.yaml -o out");
  EXPECT_EQ(FailuresIn("out"), 2U);
  const SweepResults before = ReadSweep(Path("out"));
  Write("walled.yaml", Moved());
  const Outcome outcome = Program("sweep ./rooms.yaml -o out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("out: a scene, path or movers have changed (walled.yaml)"
                                           "; as no run there had succeeded, the sweep goes on "),
                                 Not(HasSubstr("sound.yaml"))));
  EXPECT_THAT(outcome.out, HasSubstr("; 2 done already; 2 failed and tried again\n"));
  // The others are kept as they were, to their times.
  EXPECT_EQ(ReadSweep(Path("out")).times[0].values[1], before.times[0].values[1]);
  Succeed("sweep ./rooms.yaml -o anew");
  ExpectSameTable("out", "anew");
  EXPECT_EQ(ReadSweep(Path("out")).environment.at("rooms"),
            ReadSweep(Path("anew")).environment.at("rooms"));
  EXPECT_EQ(Program("sweep ./rooms.yaml -o out").err, "");
}

TEST_F(SweepCorrected, IsRefusedWhereARunHadSucceededInWhatChanged) {
  Succeed("sweep ./rooms.yaml -o out");
  Write("walled.yaml", kRoom);
  Write("sound.yaml", Moved());
  ExpectNotGoneOn("sweep ./rooms.yaml -o out",
                  "out: holds runs in a scene, path or movers that have changed: 'sound.yaml: ");
}

// One success among the failures of the changed room.
TEST_F(SweepCorrected, IsRefusedForASingleRunThatHadSucceeded) {
  Write("bands.yaml", "experiment: ./small.yaml\naxes: {mapper.scan.band_low_m: [0.1, 1.8]}\n");
  Succeed("sweep ./bands.yaml -o out");
  EXPECT_EQ(FailuresIn("out"), 1U);
  Write("room.yaml", Moved());
  ExpectNotGoneOn("sweep ./bands.yaml -o out", "out: holds runs in a scene, path or movers");
}

// Files of one name in two folders, which have each other's content now: no content is new.
TEST_F(SweepCorrected, IsRefusedWhereRoomsOfOneNameWereExchanged) {
  for (const char* folder : {"a", "b", "c"}) std::filesystem::create_directory(Path(folder));
  Write("a/room.yaml", kRoom);
  Write("b/room.yaml", Moved());
  Write("c/room.yaml", Walled());
  Write("named.yaml",
        "experiment: ./small.yaml\naxes: {scene: [./a/room.yaml, ./b/room.yaml, ./c/room.yaml]}\n");
  Succeed("sweep ./named.yaml -o out");
  EXPECT_EQ(FailuresIn("out"), 1U);
  Write("a/room.yaml", Moved());
  Write("c/room.yaml", kRoom);
  ExpectNotGoneOn("sweep ./named.yaml -o out", "out: holds runs in a scene, path or movers");
}

// What failed is part of a stop's decisions and is not done anew.
TEST_F(SweepCorrected, IsRefusedWithAStop) {
  WriteRooms(
      "  slam_seed: [1, 2, 3]\n"
      "stop: {metric: trajectory.est.mean_euclidean_m, width: 1, min_seeds: 2}\n");
  Succeed("sweep ./rooms.yaml -o out");
  Write("walled.yaml", Moved());
  ExpectNotGoneOn("sweep ./rooms.yaml -o out", "out: holds runs in a scene, path or movers");
}

// A part without a run in the room goes on as well, so that all parts are of the same rooms.
TEST_F(SweepCorrected, EachPartGoesOnAndOnlyThenTheyAreMerged) {
  const auto part = [](int i) {
    return "sweep ./rooms.yaml --shard " + std::to_string(i) + "/2 -o part" + std::to_string(i);
  };
  // One of them has failures alone.
  for (int i : {1, 2}) EXPECT_THAT(Program(part(i)).exit_code, testing::AnyOf(0, 1));
  Write("walled.yaml", Moved());
  Succeed(part(1));
  ExpectRefusal("sweep --merge part1 part2 -o whole",
                {"part2: holds runs in a scene, path or movers that have changed"});
  Succeed(part(2));
  Succeed("sweep --merge part1 part2 -o whole");
  Succeed("sweep ./rooms.yaml -o anew");
  ExpectSameTable("whole", "anew");
}

TEST_F(SweepCorrected, ReuseTakesWhatIsNotAffected) {
  Succeed("sweep ./rooms.yaml -o old");
  Write("walled.yaml", Moved());
  const Outcome outcome = Program("sweep ./rooms.yaml --reuse old -o new");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("; 2 taken from old\n"));
  Succeed("sweep ./rooms.yaml -o anew");
  ExpectSameTable("new", "anew");
  Write("sound.yaml", Walled());
  ExpectRefusal("sweep ./rooms.yaml --reuse old -o newer",
                {"old: holds runs in a scene, path or movers that have changed (sound.yaml)"});
}

}  // namespace
}  // namespace depthgrid
