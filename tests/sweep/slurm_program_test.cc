// `depthgrid sweep --executor slurm` beside a Slurm that is played by two shell scripts: what the
// waiting program leaves and takes up again. A real one: tests/slurm.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "eval/sweep/sweep_results.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// Names the job, keeps its options and does the tasks at once, one after the other, each with a log
// of the right name.
constexpr const char* kBatch = R"sh(#!/bin/sh
for word; do
  case $word in
    --array=*) tasks=$(echo "${word#--array=}" | sed 's/\([0-9]*\)-\([0-9]*\)/$(seq -s, \1 \2)/g') ;;
    --output=*) log=${word#--output=} ;;
    --job-name=*) echo "${word#--job-name=}" >> "$PLAYED/names" ;;
  esac
done
for task in $(eval echo "$tasks" | tr , ' '); do
  SLURM_ARRAY_TASK_ID=$task PATH=/usr/bin:/bin "$PLAYED/bin/task" "$word" \
    > "$(echo "$log" | sed "s/%%/%/g; s/%A/7/; s/%a/$task/")" 2>&1
done
echo 'sbatch: info: 3 jobs of yours are queued' >&2
echo '7;cluster'
)sh";

class SlurmProgram : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Write("sweep.yaml", "experiment: ./small.yaml\naxes: {seed: {seeds: 4}}\n");
    fs::create_directory(Path("bin"));
    path_ = std::getenv("PATH");
    ::setenv("PATH", (Path("bin") + ":" + path_).c_str(), 1);
    ::setenv("PLAYED", root_.c_str(), 1);
    Play("sh \"$1\"");
  }
  void TearDown() override {
    ::setenv("PATH", path_.c_str(), 1);
    ProgramTest::TearDown();
  }
  void Script(const std::string& name, const std::string& text) const {
    Write("bin/" + name, text);
    ASSERT_EQ(::chmod(Path("bin/" + name).c_str(), 0755), 0);
  }
  // A Slurm that is through with every task when sbatch returns; `task` does a job's script, $1.
  void Play(const std::string& task) const {
    Script("sbatch", kBatch);
    Script("squeue", "#!/bin/sh\n");
    Script("task", "#!/bin/sh\n" + task + "\n");
  }
  std::string TableOf(const std::string& folder) const {
    SweepResults results = ReadSweep(Path(folder));
    results.times.clear();
    return ResultsCsv(results);
  }

  std::string path_;
};

constexpr const char* kOnSlurm = "sweep ./sweep.yaml --executor slurm --slurm-tasks 2 -o ";

TEST_F(SlurmProgram, IsTheSweepDoneHereInAFolderOfAnyName) {
  Succeed("sweep ./sweep.yaml -o here");
  Succeed(kOnSlurm + std::string("\"it's 100%\""));
  EXPECT_TRUE(TableOf("it's 100%") == TableOf("here"));
  EXPECT_EQ(ReadFile(Path("names")), "depthgrid-sweep\n");
  EXPECT_TRUE(fs::exists(Path("it's 100%/slurm/7_2.log")));
}

TEST_F(SlurmProgram, StoppedItLeavesItsJobsAndPartsAndGoesOn) {
  // One part done, one that is said to run for ever.
  Play("test $SLURM_ARRAY_TASK_ID = 2 || sh \"$1\"");
  Script("squeue", "#!/bin/sh\necho 7 2\n");
  // Behind a command that ends at once: the shell itself then is in the test's folder.
  const std::string stopped = fmt::format(
      "--version; (exec '{}' {}out >log 2>&1) & "
      "for i in $(seq 300); do [ -e out/slurm/jobs.txt ] && break; sleep .1; done; "
      "kill -TERM $!; wait $!",
      kProgramFile, kOnSlurm);
  EXPECT_EQ(Program(stopped).exit_code, 128 + SIGTERM);
  EXPECT_EQ(ReadFile(Path("out/slurm/jobs.txt")), "7\n");
  const std::string part = ReadFile(Path("out/shards/1/results.csv"));
  EXPECT_THAT(ReadFile(Path("out/shards/1/progress.txt")), "2 2\n");
  EXPECT_FALSE(fs::exists(Path("out/shards/1/results.sqlite-wal")));
  Play("sh \"$1\"");
  Succeed(kOnSlurm + std::string("out"));
  EXPECT_EQ(ReadFile(Path("out/shards/1/results.csv")), part);
  Succeed("sweep ./sweep.yaml -o here");
  EXPECT_TRUE(TableOf("out") == TableOf("here"));
}

// The tasks have ended when sbatch returns; to join them takes part of a second.
TEST_F(SlurmProgram, TheEndOfItsTasksIsSeenAtOnce) {
  Script("sbatch", std::string(kBatch) + "touch \"$PLAYED/returned\"\n");
  constexpr double kLongestWaitS = 2.0;
  // Of several tries, as the machine may be busy with others.
  double least_s = INFINITY;
  for (int i = 0; i < 5 && least_s >= kLongestWaitS; ++i) {
    Succeed(fmt::format("{}out{}", kOnSlurm, i));
    const auto since = fs::file_time_type::clock::now() - fs::last_write_time(Path("returned"));
    least_s = std::min(least_s, std::chrono::duration<double>(since).count());
  }
  EXPECT_LT(least_s, kLongestWaitS);
}

TEST_F(SlurmProgram, TheQueueIsAskedEveryTwoSecondsAtMost) {
  // Tasks that go on behind sbatch's back.
  Play("(sleep 1; sh \"$1\") > /dev/null 2>&1 &");
  // Nothing is queued until something is submitted.
  Script("squeue",
         "#!/bin/sh\n"
         "echo asked >> \"$PLAYED/asked\"\n"
         "if [ -e \"$PLAYED/names\" ]; then echo 7 1; echo 7 2; fi\n");
  const auto start = std::chrono::steady_clock::now();
  Succeed(kOnSlurm + std::string("out"));
  const double took_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string asked = ReadFile(Path("asked"));
  EXPECT_LE(std::count(asked.begin(), asked.end(), '\n'), 1 + took_s / 2.0);
}

// As a kill after the database, before the table, leaves them.
TEST_F(SlurmProgram, ATableThatIsMissingIsWritten) {
  Succeed(kOnSlurm + std::string("out"));
  const std::string table = ReadFile(Path("out/results.csv"));
  fs::remove(Path("out/results.csv"));
  Succeed(kOnSlurm + std::string("out"));
  EXPECT_EQ(ReadFile(Path("out/results.csv")), table);
  EXPECT_EQ(ReadFile(Path("names")), "depthgrid-sweep\n");  // no job was started again
}

TEST_F(SlurmProgram, APartThatComesToNothingLeavesItsLogToRead) {
  Play("echo no such node; test $SLURM_ARRAY_TASK_ID = 2 || sh \"$1\"");
  const Outcome outcome = Program(kOnSlurm + std::string("out"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("part 2 ended 3 times without a result"));
  EXPECT_THAT(ReadFile(Path("out/slurm/7_2.log")), HasSubstr("no such node"));
  EXPECT_TRUE(fs::exists(Path("out/shards/1/results.csv")));
}

TEST_F(SlurmProgram, WithoutSlurmItSaysSoAtOnce) {
  Script("squeue", "#!/bin/sh\necho slurm_load_jobs error: no controller >&2\nexit 1\n");
  const Outcome outcome = Program(kOnSlurm + std::string("out"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.err, "depthgrid: squeue failed: slurm_load_jobs error: no controller\n");
  EXPECT_FALSE(fs::exists(Path("out")));
  Script("squeue", "#!/bin/sh\n");
  Script("sbatch", "#!/bin/sh\necho invalid partition >&2\nexit 1\n");
  EXPECT_THAT(Program(kOnSlurm + std::string("out")).err,
              StartsWith("depthgrid: sbatch refused: invalid partition"));
  EXPECT_FALSE(fs::exists(Path("out")));
}

TEST_F(SlurmProgram, ADamagedNumberOfPartsIsNamed) {
  fs::create_directories(Path("out/shards"));
  Write("out/.lock", "");
  Write("out/shards/parts.txt", "many\n");
  const Outcome outcome = Program(kOnSlurm + std::string("out"));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("shards/parts.txt: is 'many', must be a whole number"));
}

}  // namespace
}  // namespace depthgrid
