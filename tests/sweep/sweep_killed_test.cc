// A sweep that is killed again and again goes on where it was.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <set>
#include <thread>

#include "eval/sweep/sweep_database.h"
#include "tests/sweep/sweep_tables.h"

namespace depthgrid {
namespace {

class KilledSweep : public SweepTableTest {
 protected:
  // Starts the program, waits until the sweep has so many rows and then a little, and kills it;
  // how many rows it left. Nothing when it ended before.
  std::optional<std::size_t> RowsWhenKilled(const std::vector<std::string>& arguments,
                                            const std::string& folder, std::size_t rows,
                                            std::chrono::microseconds longer) const {
    const pid_t child = ::fork();
    if (child == 0) {
      std::vector<char*> argv = {const_cast<char*>(kProgramFile)};
      for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
      argv.push_back(nullptr);
      const bool quiet = ::chdir(root_.c_str()) == 0 &&
                         std::freopen("/dev/null", "w", stdout) != nullptr &&
                         std::freopen("killed.stderr", "w", stderr) != nullptr;
      if (quiet) ::execv(kProgramFile, argv.data());
      ::_exit(1);
    }
    const auto open = [&]() -> std::optional<SweepDatabase> {
      if (!SweepDatabase::Exists(Path(folder))) return std::nullopt;
      return SweepDatabase::Open(Path(folder));
    };
    const auto done = [](const std::optional<SweepDatabase>& database) {
      return database ? database->FinishedRuns().size() : 0;
    };
    int status = 0;
    {
      // Opened once, because that takes longer than asking; and closed before the kill, so that the
      // killed program leaves the database as if nobody else had it open.
      std::optional<SweepDatabase> database = open();
      while (done(database) < rows && ::waitpid(child, &status, WNOHANG) == 0) {
        ::usleep(1000);
        if (!database) database = open();
      }
    }
    std::this_thread::sleep_for(longer);
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    if (!WIFSIGNALED(status)) {
      ADD_FAILURE() << "ended with " << WEXITSTATUS(status) << " and " << done(open())
                    << " rows: " << ReadFile(Path("killed.stderr"));
      return std::nullopt;
    }
    return done(open());
  }
};

// A fifth of it under a sanitizer, where a start and a run take ten times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kKills = 10;
#else
constexpr std::size_t kKills = 50;
#endif

TEST_F(KilledSweep, FiftyTimesItIsTheSameTable) {
  constexpr std::size_t kRuns = 3 * kKills;
  Write("many.yaml", fmt::format(R"(
experiment: ./small.yaml
axes:
  mapper.fusion.gain: {{from: 0, to: 1, count: 10}}
  seed: {{seeds: {}}}
)",
                                 kRuns / 10));
  Succeed("sweep ./many.yaml -j 2 -o whole");
  std::set<std::size_t> rows_left;
  for (std::size_t kill = 0; kill < kKills; ++kill) {
    const std::size_t rows = kRuns * 3 / 4 * kill / kKills;  // the rest is done by the last start
    // From the first moments of a start to the middle of a run.
    const std::chrono::microseconds longer(kill < 10 ? 10'000 * kill : 997 * kill % 10'000);
    const auto left =
        RowsWhenKilled({"sweep", "./many.yaml", "-j", "2", "-o", "killed"}, "killed", rows, longer);
    ASSERT_TRUE(left.has_value()) << "ended before kill " << kill;
    rows_left.insert(*left);
  }
  EXPECT_GE(rows_left.size(), kKills / 2);
  EXPECT_LT(*rows_left.rbegin(), kRuns);
  Succeed("sweep ./many.yaml -j 2 -o killed");
  ExpectSameTable("whole", "killed");
}

}  // namespace
}  // namespace depthgrid
