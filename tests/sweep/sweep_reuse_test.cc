// `depthgrid sweep --reuse OLD`: more seeds and other values without doing all again.
#include <gmock/gmock.h>

#include "eval/sweep/sweep_database.h"
#include "tests/sweep/sweep_tables.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SweepReuse : public SweepTableTest {
 protected:
  void SetUp() override {
    SweepTableTest::SetUp();
    WriteSweep("old.yaml", "mapper.fusion.gain: [0, 0.5]\n  seed: {seeds: 2}");
  }
  void WriteSweep(const std::string& name, const std::string& axes,
                  const std::string& more = "") const {
    Write(name, "experiment: ./small.yaml\naxes:\n  " + axes + "\n" + more);
  }
  std::string EntryOf(const std::string& folder, const std::string& key) const {
    return ReadSweep(Path(folder)).environment.at(key);
  }
};

// The axes may stand in another order, and the old sweep may be a part.
TEST_F(SweepReuse, GivesTheTableOfASweepThatDidAllRuns) {
  Succeed("sweep ./old.yaml -o old");
  WriteSweep("new.yaml", "seed: {seeds: 3}\n  mapper.fusion.gain: [0, 0.25, 0.5]");
  const Outcome dry = Program("sweep ./new.yaml --reuse old --dry-run -o new");
  EXPECT_THAT(dry.out, HasSubstr("9 runs, 3 points x 3 seeds; 4 taken from old\n"));
  const Outcome outcome = Program("sweep ./new.yaml --reuse old -o new");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("; 4 taken from old\n"));
  Succeed("sweep ./new.yaml -o anew");
  ExpectSameTable("new", "anew");
  // Their times are the old ones.
  const SweepResults there = ReadSweep(Path("old")), here = ReadSweep(Path("new"));
  EXPECT_EQ(there.times[0].values[3], here.times[0].values[7]);  // gain 0.5, seed 2
  EXPECT_EQ(there.times[0].values[0], here.times[0].values[0]);
  const Outcome again = Program("sweep ./new.yaml --reuse old -o new");
  EXPECT_THAT(again.out, HasSubstr("; 9 done already; 0 taken from old\n"));
  for (const char* part : {"1", "2"}) {
    Succeed(std::string("sweep ./old.yaml --shard ") + part + "/2 -o part" + part);
    Succeed(std::string("sweep ./new.yaml --reuse part1 --shard ") + part + "/2 -o new" + part);
  }
  Succeed("sweep --merge new1 new2 -o joined");
  ExpectSameTable("joined", "anew");
}

// Sweeps of other seeds or values are joined by one of all, which computes nothing.
TEST_F(SweepReuse, JoinsSeveralSweeps) {
  WriteSweep("seeds.yaml", "mapper.fusion.gain: [0, 0.5]\n  seed: {seeds: 1, first: 3}");
  WriteSweep("gain.yaml", "mapper.fusion.gain: [0.5, 1]\n  seed: {seeds: 3}");
  WriteSweep("all.yaml", "mapper.fusion.gain: [0, 0.5, 1]\n  seed: {seeds: 3}");
  Succeed("sweep ./old.yaml -o old");
  Succeed("sweep ./seeds.yaml -o seeds");
  Succeed("sweep ./gain.yaml -o gain");
  const Outcome outcome = Program("sweep --reuse old --reuse seeds --reuse gain ./all.yaml -o all");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("9 runs, 3 points x 3 seeds; 9 taken from old, seeds, gain\n"));
  Succeed("sweep ./all.yaml -o anew");
  ExpectSameTable("all", "anew");
  // Of a run that several have, the first is taken: gain 0.5, seed 1.
  EXPECT_EQ(ReadSweep(Path("old")).times[0].values[2], ReadSweep(Path("all")).times[0].values[3]);
  const Outcome other = Program("sweep ./all.yaml -o old");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("here; choose another folder, where --reuse takes over its runs,"
                                   " or remove this one\n"));
  ExpectRefusal("sweep --merge old seeds -o merged",
                {"seeds: holds another sweep",
                 "parts are of one sweep; a sweep of all values with a "
                 "--reuse for each folder joins several\n"});
  ExpectRefusal("sweep ./all.yaml --reuse old --reuse none -o out", {"none: is no sweep's folder"});
}

// Other runs of the old sweep have scores that these have not.
TEST_F(SweepReuse, HasNoColumnsOfRunsThatItDoesNotTake) {
  WriteSweep("both.yaml", "metrics.navigation: [true, false]");
  WriteSweep("one.yaml", "metrics.navigation: [false]");
  Succeed("sweep ./both.yaml -o both");
  const Outcome outcome = Program("sweep ./one.yaml --reuse both -o one");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("; 1 taken from both\n"));
  Succeed("sweep ./one.yaml -o anew");
  ExpectSameTable("one", "anew");
  EXPECT_THAT(TableOf("both"), HasSubstr("navigability"));
  EXPECT_THAT(TableOf("one"), Not(HasSubstr("navigability")));
}

TEST_F(SweepReuse, TakesNoFailuresAndSaysOfWhichBuildsItIs) {
  WriteSweep("failing.yaml", "mapper.scan.band_low_m: [0.1, 1.8]");
  WriteSweep("more.yaml", "mapper.scan.band_low_m: [0.1, 0.2, 1.8]");
  Succeed("sweep ./failing.yaml -j 2 -o old");
  const std::string build = EntryOf("old", "build");
  SweepDatabase::Open(Path("old")).Note("build", "0123456789ab");
  const Outcome outcome = Program("sweep ./more.yaml --reuse old -j 1 -o new");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("; 1 taken from old\n"));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("several builds of the program (0123456789ab, " + build),
                                 HasSubstr("1 of 3 runs failed")));
  EXPECT_EQ(EntryOf("new", "jobs"), "2, 1");
  WriteSweep("less.yaml", "mapper.scan.band_low_m: [0.1]");
  EXPECT_EQ(Program("sweep ./less.yaml --reuse old -o less").err, "");
  EXPECT_EQ(EntryOf("less", "build"), "0123456789ab");
}

TEST_F(SweepReuse, TakesNothingFromAnotherSweep) {
  Succeed("sweep ./old.yaml -o old");
  const auto refuse = [&](const std::string& arguments, const std::vector<std::string>& says) {
    ExpectRefusal("sweep " + arguments + " -o out", says);
  };
  refuse("./old.yaml --reuse none", {"none: is no sweep's folder"});
  refuse("./old.yaml --reuse old --set frames=13",
         {"old: holds a sweep of another experiment: 'frames: 12' there, 'frames: 13' here; its "
          "runs cannot be taken over\n"});
  refuse("./old.yaml --reuse old --set sensor.noise_scale=1",
         {"old: holds a sweep with other keys"});
  WriteSweep("axis.yaml", "slam_seed: [1, 2]");
  refuse("./axis.yaml --reuse old",
         {"old: holds a sweep over mapper.fusion.gain, seed, here it is slam_seed; its"});
  const std::string stop = "stop: {metric: trajectory.est.mean_euclidean_m, width: 1}\n";
  WriteSweep("stop.yaml", "seed: {seeds: 6}\n  mapper.fusion.gain: [0, 0.5]", stop);
  refuse("./stop.yaml --reuse old", {"--reuse: the sweep has a `stop`, whose decisions depend"});
  refuse("--merge old --reuse old", {"--reuse: has no meaning with --merge"});
  const Outcome own = Program("sweep ./old.yaml --reuse old -o old");
  EXPECT_EQ(own.exit_code, 2);
  EXPECT_THAT(own.err, HasSubstr("--reuse old: is the output's own folder"));
  SweepDatabase::Open(Path("old")).Note("again", "mode: grid\nstop: {metric: x, width: 1}\n");
  refuse("./old.yaml --reuse old", {"old: its sweep has a `stop`, whose"});
  SweepDatabase::Open(Path("old")).Note("again", "");
  Write("room.yaml", ReadFile(Path("room.yaml")) + "# the same\n");
  Succeed("sweep ./old.yaml --reuse old --dry-run -o out");
  std::string moved = ReadFile(Path("room.yaml"));
  moved.replace(moved.find("0.4, 2.0"), 8, "0.4, 2.1");
  Write("room.yaml", moved);
  refuse("./old.yaml --reuse old",
         {"old: holds runs in a scene, path or movers that have changed (room.yaml)"});
}

}  // namespace
}  // namespace depthgrid
