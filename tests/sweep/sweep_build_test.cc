// Which builds of the program a sweep's runs are of.
#include <gmock/gmock.h>

#include "eval/output/build_id.h"
#include "eval/sweep/sweep_database.h"
#include "eval/sweep/sweep_folder.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class SweepBuild : public ProgramTest {
 protected:
  // One of its runs fails, and is tried again with every start.
  void SetUp() override {
    ProgramTest::SetUp();
    Write("sweep.yaml", R"(
experiment: ./small.yaml
axes:
  mapper.scan.band_low_m: [0.1, 1.8]
)");
  }
  // The program's: it may be built of newer sources than this test.
  std::string ProgramBuild() const {
    const std::string version = Program("--version").out;
    const std::size_t begin = version.find('(') + 1;
    return version.substr(begin, version.find(')') - begin);
  }
  std::string BuildOf(const std::string& folder) const {
    return ReadSweep(Path(folder)).environment.at("build");
  }
};

TEST_F(SweepBuild, RunsOfAnotherBuildAreKeptAndSaid) {
  const Outcome first = Program("sweep ./sweep.yaml -o out");
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_THAT(first.err, Not(HasSubstr("builds")));
  EXPECT_EQ(BuildOf("out"), ProgramBuild());
  SweepDatabase::Open(Path("out")).Note("build", "0123456789ab");
  const std::string both = "0123456789ab, " + ProgramBuild();
  for (int again = 0; again < 2; ++again) {
    const Outcome outcome = Program("sweep ./sweep.yaml -o out");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("out: its runs are of several builds of the program (" +
                                       both + "), which may give other numbers\n"));
    EXPECT_EQ(BuildOf("out"), both);
  }
  EXPECT_EQ(ReadSweep(Path("out")).rows(), 2U);
  EXPECT_THAT(ReadFile(Path("out/report.html")), HasSubstr(both));
}

TEST_F(SweepBuild, NothingOfABuildThatDidNoRunIsSaid) {
  std::filesystem::create_directory(Path("out"));
  SweepDatabase database = SweepDatabase::Create(Path("out"), {{"build", "0123456789ab"}}, {"seed"},
                                                 {{0, 0, {"1"}}, {1, 0, {"2"}}});
  NoteWork(database, 2);
  EXPECT_EQ(database.Environment().at("build"), BuildId());
  database.Record({0, "", {{"a", 1.0}}, {}});
  database.Record({1, "", {{"a", 2.0}}, {}});
  database.Note("build", "0123456789ab");
  NoteWork(database, 2);  // all done: this build has nothing to do
  EXPECT_EQ(database.Environment().at("build"), "0123456789ab");
}

TEST_F(SweepBuild, JoinedPartsNameAllBuilds) {
  Write("seeds.yaml", "experiment: ./small.yaml\naxes: {seed: {seeds: 3}}\n");
  for (const char* part : {"1", "2", "3"}) {
    Succeed(std::string("sweep ./seeds.yaml --shard ") + part + "/3 -o part" + part);
  }
  const Outcome same = Program("sweep --merge part1 part2 part3 -o same");
  EXPECT_THAT(same.err, Not(HasSubstr("builds")));
  EXPECT_EQ(BuildOf("same"), ProgramBuild());
  SweepDatabase::Open(Path("part2")).Note("build", "ba0123456789, " + ProgramBuild());
  SweepDatabase::Open(Path("part3")).Note("build", "a0123456789b");
  const Outcome joined = Program("sweep --merge part1 part2 part3 -o joined");
  EXPECT_EQ(joined.exit_code, 0);
  EXPECT_EQ(BuildOf("joined"), ProgramBuild() + ", ba0123456789, a0123456789b");
  EXPECT_THAT(joined.err, HasSubstr("joined: its runs are of several builds"));
}

// Wall times mean little without.
TEST_F(SweepBuild, HowManyRunsWereDoneAtATimeIsKept) {
  const auto jobs_of = [&](const char* folder) {
    return SweepDatabase::Open(Path(folder)).Environment().at("jobs");
  };
  Write("seeds.yaml", "experiment: ./small.yaml\naxes: {seed: {seeds: 3}}\n");
  Succeed("sweep ./seeds.yaml --shard 1/3 -j 1 -o part1");
  Succeed("sweep ./seeds.yaml --shard 2/3 -j 2 -o part2");
  Succeed("sweep ./seeds.yaml --shard 3/3 -j 1 -o part3");
  EXPECT_EQ(jobs_of("part2"), "2");
  Succeed("sweep ./seeds.yaml --shard 2/3 -j 4 -o part2");  // nothing to do
  EXPECT_EQ(jobs_of("part2"), "2");
  Succeed("sweep --merge part1 part2 part3 -o joined");
  EXPECT_EQ(jobs_of("joined"), "1, 2");
  // The page of the whole does not tell.
  Succeed("sweep ./seeds.yaml -j 2 -o whole");
  EXPECT_EQ(ReadFile(Path("joined/report.html")), ReadFile(Path("whole/report.html")));

  std::filesystem::create_directory(Path("out"));
  SweepDatabase database =
      SweepDatabase::Create(Path("out"), {}, {"seed"}, {{0, 0, {"1"}}, {1, 0, {"2"}}});
  NoteWork(database, 4);
  NoteWork(database, 2);
  EXPECT_EQ(database.Environment().at("jobs"), "2");  // no run was done by the first
  database.Record({0, "", {{"a", 1.0}}, {}});
  NoteWork(database, 1);
  EXPECT_EQ(database.Environment().at("jobs"), "2, 1");
}

TEST_F(SweepBuild, IsInARunsProvenance) {
  Succeed("run ./small.yaml -o run");
  EXPECT_THAT(ReadFile(Path("run/run.yaml")), HasSubstr("\n  build: " + ProgramBuild() + "\n"));
  EXPECT_THAT(VersionText(), HasSubstr(" (" + BuildId() + ")"));
}

}  // namespace
}  // namespace depthgrid
