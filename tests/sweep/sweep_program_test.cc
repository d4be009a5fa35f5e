// `depthgrid sweep` end to end: the same table however it came about.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "eval/sweep/sweep_metrics.h"
#include "tests/sweep/sweep_tables.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

class ProgramSweep : public SweepTableTest {
 protected:
  void SetUp() override {
    SweepTableTest::SetUp();
    Write("sweep.yaml", kSweep);
  }

  static constexpr const char* kSweep = R"(
experiment: ./small.yaml
axes:
  mapper.fusion.gain: {from: 0, to: 1, count: 3}
  seed: {seeds: 2}
  sensor.noise: [none, handa]
)";
};

TEST_F(ProgramSweep, GivesTheScoresOfSingleRuns) {
  Succeed("sweep ./sweep.yaml -o out");
  Succeed(
      "run ./small.yaml --set mapper.fusion.gain=0.5 --set seed=2 --set sensor.noise=none -o run");
  const SweepResults results = ReadSweep(Path("out"));
  ASSERT_EQ(results.rows(), 12U);
  std::size_t row = 0;
  for (; row < results.rows(); ++row) {
    if (results.Parameter("mapper.fusion.gain").numbers[row] == 0.5 &&
        results.Parameter("seed").numbers[row] == 2 &&
        results.Parameter("sensor.noise").texts[row] == "none") {
      break;
    }
  }
  ASSERT_LT(row, results.rows());
  const auto metrics = nlohmann::json::parse(ReadFile(Path("run/metrics.json")));
  int compared = 0;
  const std::vector<std::string> names = SweepMetricNames();
  for (const SweepColumn& column : results.metrics) {
    EXPECT_THAT(names, ::testing::Contains(column.name));
    std::string pointer = "/" + column.name;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    const auto& value = metrics[nlohmann::json::json_pointer(pointer)];
    if (value.is_null()) {
      EXPECT_TRUE(std::isnan(column.values[row])) << column.name;
      continue;
    }
    EXPECT_EQ(value.get<double>(), column.values[row]) << column.name;
    ++compared;
  }
  EXPECT_GT(compared, 40);
}

TEST_F(ProgramSweep, IsTheSameTableWithOneAndTwoWorkersAndWithoutACache) {
  Succeed("sweep ./sweep.yaml -j 1 -o one");
  Succeed("sweep ./sweep.yaml -j 2 -o two");
  Succeed("sweep ./sweep.yaml -j 2 --no-cache -o bare");
  ExpectSameTable("one", "two");
  ExpectSameTable("one", "bare");
  EXPECT_FALSE(std::filesystem::exists(Path("one/cache")));
}

TEST_F(ProgramSweep, PartsJoinToTheWhole) {
  Succeed("sweep ./sweep.yaml -o whole");
  for (const char* part : {"1", "2", "3"}) {
    Succeed(std::string("sweep ./sweep.yaml --shard ") + part + "/3 -o part" + part);
  }
  Succeed("sweep --merge part2 part3 part1 -o joined");
  ExpectSameTable("whole", "joined");
  const Outcome incomplete = Program("sweep --merge part1 part3 -o lacking");
  EXPECT_EQ(incomplete.exit_code, 2);
  EXPECT_THAT(incomplete.err, HasSubstr("part 2/3 is missing"));
  EXPECT_FALSE(std::filesystem::exists(Path("lacking")));
  EXPECT_EQ(Program("sweep --merge part1 part2 part3 part1 -o doubled").exit_code, 2);
}

TEST_F(ProgramSweep, AFailingRunIsRecordedAndTheOthersGoOn) {
  Write("failing.yaml", R"(
experiment: ./small.yaml
axes:
  mapper.scan.band_low_m: [0.1, 1.8, 0.2]
)");
  const Outcome outcome = Program("sweep ./failing.yaml -o out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("1 of 3 runs failed, the first: ./failing.yaml:4: mapper"));
  const SweepResults results = ReadSweep(Path("out"));
  ASSERT_EQ(results.rows(), 3U);
  EXPECT_THAT(results.failures[1], HasSubstr("mapper.scan.band_low_m"));
  EXPECT_EQ(results.failures[0] + results.failures[2], "");
  const auto& error = results.Metric("trajectory.est.mean_euclidean_m");
  EXPECT_TRUE(std::isnan(error[1]));
  EXPECT_TRUE(std::isfinite(error[0]) && std::isfinite(error[2]));
  const Outcome again = Program("sweep ./failing.yaml -o out");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.out, HasSubstr("; 2 done already; 1 failed and tried again\n"));
  EXPECT_EQ(ReadSweep(Path("out")).failures, results.failures);
}

// The first point fails: the time is that of the next one, the page begins where there is
// something.
TEST_F(ProgramSweep, TheFirstPointMayFail) {
  Write("failing.yaml", R"(
experiment: ./small.yaml
axes:
  mapper.scan.band_low_m: [1.8, 0.1]
  mapper.fusion.gain: [0, 0.5]
)");
  const Outcome dry = Program("sweep ./failing.yaml --dry-run -o out");
  EXPECT_THAT(dry.out, HasSubstr("about "));
  Write("hopeless.yaml", "experiment: ./small.yaml\naxes: {mapper.scan.band_low_m: [1.8, 1.9]}\n");
  const Outcome hopeless = Program("sweep ./hopeless.yaml --dry-run -o out");
  EXPECT_THAT(hopeless.out, testing::ContainsRegex("the first points fail: .*band_low_m is 1.8, "));
}

TEST_F(ProgramSweep, FailsWhenAllRunsDo) {
  Write("failing.yaml", "experiment: ./small.yaml\naxes: {mapper.scan.band_low_m: [1.8, 1.9]}\n");
  const Outcome outcome = Program("sweep ./failing.yaml -o out");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("depthgrid: 2 of 2 runs failed, the first: "));
  EXPECT_EQ(ReadSweep(Path("out")).rows(), 2U);
}

TEST_F(ProgramSweep, APointStopsWhenItIsSure) {
  Write("stop.yaml", R"(
experiment: ./small.yaml
axes:
  seed: {seeds: 8}
  slam.drift_scale: [0.01, 1000]
stop: {metric: trajectory.slam.mean_euclidean_m, width: 0.01, min_seeds: 3}
)");
  Succeed("sweep ./stop.yaml -j 1 -o one");
  Succeed("sweep ./stop.yaml -j 2 -o two");
  ExpectSameTable("one", "two");
  for (const char* part : {"1", "2"}) {
    Succeed(std::string("sweep ./stop.yaml --shard ") + part + "/2 -o part" + part);
  }
  Succeed("sweep --merge part1 part2 -o joined");
  ExpectSameTable("one", "joined");
  int calm = 0;
  int wild = 0;
  const SweepResults one = ReadSweep(Path("one"));
  for (const double scale : one.Parameter("slam.drift_scale").numbers) {
    ++(scale < 1.0 ? calm : wild);
  }
  EXPECT_EQ(calm, 3);
  EXPECT_EQ(wild, 8);
}

TEST_F(ProgramSweep, SaysWhatItIsGoingToDo) {
  const Outcome dry = Program("sweep ./sweep.yaml --dry-run -o out");
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  EXPECT_THAT(dry.out, HasSubstr("12 runs, 6 points x 2 seeds"));
  EXPECT_THAT(dry.out, HasSubstr("4 different sets of scans"));
  EXPECT_FALSE(std::filesystem::exists(Path("out")));
}

TEST_F(ProgramSweep, ErrorsAreOneLineAndLeaveNothing) {
  const auto expect = [&](const std::string& axes, const std::string& message) {
    Write("bad.yaml", "experiment: ./small.yaml\n" + axes);
    const Outcome outcome = Program("sweep ./bad.yaml -o out");
    EXPECT_EQ(outcome.exit_code, 2) << axes;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << axes;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(Path("out"))) << axes;
  };
  expect("axes: {mapper.fusion.gian: [0, 1]}\n", "did you mean 'mapper.fusion.gain'?");
  expect("axes:\n  seed: [1]\n  mapper.fusion.gain: [0, 2]\n", "bad.yaml:4: mapper.fusion.gain is");
  expect("axes: {mapper.fusion.gain: []}\n", "axis 'mapper.fusion.gain' has no values");
  expect("axes: {mapper.fusion.gain: }\n", "axis 'mapper.fusion.gain' has no values");
  expect("axes: {}\n", "has no axes");
  expect("seeds: 3\n", "key 'axes' is missing");
  expect("axes: {seed: [1, 1]}\n", "has the value 1 twice");
  expect("axes: {seed: [1], 'seed, frames': [[1, 2]]}\n", "is on two axes");
  expect("axes: {scene: [./room.yaml, living_roo]}\n", "did you mean 'living_room'?");
  expect("axes: {seed: [1]}\nstop: {metric: map.all.chamfer, width: 1}\n", "'map.all.chamfer_m'?");
  expect("axes: {seed: [1]}\nmod: zip\n", "did you mean 'mode'?");
  expect("mode: zip\naxes: {frames: [1, 2], mapper.fusion.gain: [0]}\n", "the same number");
  expect("mode: random\naxes: {frames: [1, 2]}\n", "needs 'samples'");
  expect("axes: {mapper.fusion.gain: {from: 0, to: 1}}\n", "needs 'count'");
  expect("axes: {frames: {from: 0, to: 9, count: 2, scale: log}}\n", "must lie above 0");
  expect("axes: {frames: {from: 1, to: 9, count: 1}}\n", "count 1 from 1 to 9 must be 2 or more");
  expect("axes: {frames: {from: 1, two: 9, count: 2}}\n", "unknown key 'two'");
  expect("axes: {sequence.from_s: [1, 2]}\n", "for `depthgrid map`");
  EXPECT_EQ(Program("sweep ./sweep.yaml --shard 3/2 -o out").exit_code, 2);
  EXPECT_EQ(Program("sweep nothing_like_this -o out").exit_code, 2);
}

TEST_F(ProgramSweep, GoesOnOnlyWithTheSameSweep) {
  Succeed("sweep ./sweep.yaml -o out");
  const std::string table = TableOf("out");
  Succeed("sweep ./sweep.yaml -o out");
  EXPECT_TRUE(TableOf("out") == table);
  const Outcome other = Program("sweep ./sweep.yaml --set frames=11 -o out");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("'frames: 12' there, 'frames: 11' here"));
  EXPECT_EQ(Program("sweep ./sweep.yaml --shard 1/2 -o out").exit_code, 2);
  std::filesystem::create_directory(Path("mine"));
  Write("mine/notes.txt", "mine");
  EXPECT_EQ(Program("sweep ./sweep.yaml -o mine").exit_code, 2);
  EXPECT_EQ(FilesIn("mine"), std::vector<std::string>{"notes.txt"});
}

TEST_F(ProgramSweep, ForceMixesNoResults) {
  std::filesystem::create_directory(Path("run"));
  Write("run/run.yaml", "scene: ./room.yaml\n");
  const Outcome into_run = Program("sweep ./sweep.yaml -o run --force");
  EXPECT_EQ(into_run.exit_code, 2);
  EXPECT_THAT(into_run.err, HasSubstr("run: holds a run; choose another folder"));
  EXPECT_EQ(FilesIn("run"), std::vector<std::string>{"run.yaml"});
  std::filesystem::create_directory(Path("mine"));
  Write("mine/notes.txt", "mine");
  Succeed("sweep ./sweep.yaml -o mine --force");
  EXPECT_EQ(ReadFile(Path("mine/notes.txt")), "mine");
  const Outcome other = Program("sweep ./sweep.yaml --set frames=11 -o mine --force");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("here; choose another folder, or remove this one"));
  EXPECT_THAT(Program("run ./small.yaml -o mine --force").err, HasSubstr("mine: holds a sweep"));
}

TEST_F(ProgramSweep, TooManyRunsAreRefusedAtOnce) {
  const auto error = [&](const std::string& axes) {
    Write("many.yaml", "experiment: ./small.yaml\n" + axes);
    const Outcome outcome = Program("sweep ./many.yaml --dry-run -o out");
    EXPECT_EQ(outcome.exit_code, 2) << axes;
    return outcome.err;
  };
  EXPECT_EQ(
      error("axes: {mapper.fusion.gain: {from: 0, to: 1, count: 1001}, seed: {seeds: 1000}}\n"),
      "depthgrid: ./many.yaml: has 1001000 runs, must have at most 100000\n");
  EXPECT_THAT(error("axes: {mapper.fusion.gain: {from: 0, to: 1, count: 1000000}}\n"),
              HasSubstr("many.yaml:2: count is '1000000', must be from 1 to 100000"));
  EXPECT_THAT(error("mode: random\nsamples: 2000\naxes: {mapper.fusion.gain: {from: 0, to: 1}, "
                    "seed: {seeds: 100}}\n"),
              HasSubstr("has 200000 runs"));
}

// Half of the runs in one room and half in another would be in one table.
TEST_F(ProgramSweep, DoesNotGoOnInAChangedRoom) {
  Succeed("sweep ./sweep.yaml -o out");
  const std::string table = ReadFile(Path("out/results.csv"));
  std::string room = kRoom;
  room.replace(room.find("0.5, 0.5, 1.5"), 13, "0.6, 0.5, 1.5");
  Write("room.yaml", room);
  const Outcome changed = Program("sweep ./sweep.yaml -o out");
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_THAT(changed.err, HasSubstr("out: holds runs in a scene, path or movers that have "
                                     "changed: 'room.yaml: "));
  EXPECT_EQ(ReadFile(Path("out/results.csv")), table);
  room = kRoom;
  room.replace(room.find("[1.9, 2.0, 1.1]"), 15, "[1.8, 2.0, 1.1]");
  Write("room.yaml", room);
  EXPECT_EQ(Program("sweep ./sweep.yaml -o out").exit_code, 2);
  Write("room.yaml", std::string("# not to be seen\n") + kRoom);
  EXPECT_EQ(Program("sweep ./sweep.yaml -o out").exit_code, 0);
}

// Where nothing may be written a sweep is read all the same, and its page goes elsewhere.
TEST_F(ProgramSweep, OfAFolderThatMayNotBeWrittenThePageGoesElsewhere) {
  namespace fs = std::filesystem;
  Succeed("sweep ./sweep.yaml -o out");
  fs::create_directory(Path("pages"));
  fs::permissions(Path("pages"), fs::perms::all);
  for (const char* file : {"out/results.sqlite", "out/.lock", "out/report.html"}) {
    ASSERT_EQ(::chmod(Path(file).c_str(), 0444), 0);
  }
  ASSERT_EQ(::chmod(Path("out").c_str(), 0555), 0);
  // Root may write everywhere.
  const std::string nobody =
      ::geteuid() == 0 ? "setpriv --reuid=65534 --regid=65534 --clear-groups " : "";
  const auto program = [&](const std::string& arguments) {
    const std::string command = "cd '" + Path("pages") + "' && " + nobody + "'" + kProgramFile +
                                "' " + arguments + " >'" + Path("said") + "' 2>&1";
    const int status = std::system(command.c_str());
    return Outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadFile(Path("said")), ""};
  };
  if (program("--version").exit_code != 0) GTEST_SKIP() << "no unprivileged user runs the program";
  const Outcome elsewhere = program("report ../out -o page");
  EXPECT_EQ(elsewhere.exit_code, 0) << elsewhere.out;
  EXPECT_EQ(elsewhere.out, "look at page/report.html\n");
  EXPECT_THAT(ReadFile(Path("pages/page/report.html")), HasSubstr("\"back\":\"../../out/\""));
  const Outcome compared = program("compare ../out ../out");
  EXPECT_EQ(compared.exit_code, 0) << compared.out;
  const Outcome in_place = program("report ../out");
  EXPECT_EQ(in_place.exit_code, 2);
  EXPECT_EQ(in_place.out,
            "depthgrid: ../out: cannot be written: Permission denied; -o names "
            "another folder for the page\n");
  const Outcome again = program("sweep ../sweep.yaml -o ../out");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_EQ(again.out, "depthgrid: ../out: cannot be written: Permission denied\n");
  ASSERT_EQ(::chmod(Path("out").c_str(), 0755), 0);
  // What was not put into the database yet would be missed.
  Write("out/results.sqlite-wal", "runs");
  ASSERT_EQ(::chmod(Path("out").c_str(), 0555), 0);
  const Outcome unfinished = program("report ../out -o page2");
  EXPECT_EQ(unfinished.exit_code, 2);
  EXPECT_THAT(unfinished.out, HasSubstr("results.sqlite-wal: holds the sweep's last runs"));
  ASSERT_EQ(::chmod(Path("out").c_str(), 0755), 0);
}

}  // namespace
}  // namespace depthgrid
