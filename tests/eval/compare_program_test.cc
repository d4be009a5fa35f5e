// `depthgrid compare` on folders of runs: what it says, and what it refuses.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/eval/program.h"
#include "tests/statistics/ten_runs.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kComparedScore = "trajectory.est.mean_euclidean_m";

// Runs' folders with what is read of them.
class ProgramCompare : public ProgramTest {
 protected:
  void WriteRuns(const std::string& folder, const std::vector<double>& errors) const {
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const std::string run = fmt::format("{}/{}", folder, i);
      std::filesystem::create_directories(Path(run));
      Write(run + "/run.yaml",
            fmt::format("scene: room\ntrajectory: walk\nframes: 9\nseed: {}\n", i + 1));
      Write(run + "/metrics.json",
            fmt::format(R"({{"trajectory": {{"est": {{"mean_euclidean_m": {}}}}}}})", errors[i]));
    }
  }
};

TEST_F(ProgramCompare, FoldersOfRuns) {
  WriteRuns("a", kA);
  WriteRuns("b", kB);
  const Outcome table = Program("compare a b");
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("10 pairs"));
  EXPECT_THAT(table.out, HasSubstr("B better"));
  const auto json = nlohmann::json::parse(Program("compare a b --json").out);
  EXPECT_EQ(json["pairs"], 10);
  EXPECT_EQ(json["metrics"][kComparedScore]["verdict"], "b");
  EXPECT_NEAR(json["metrics"][kComparedScore]["p_value"].get<double>(), 0.009765625, 1e-12);
  EXPECT_EQ(json["metrics"][kComparedScore]["seeds_needed"], 12);
  // Single runs: the difference alone.
  const Outcome single = Program("compare a/0 b/0");
  EXPECT_EQ(single.exit_code, 0) << single.err;
  EXPECT_THAT(single.out, HasSubstr("too few pairs"));
  EXPECT_THAT(single.out, HasSubstr("Too few pairs for any verdict: one row needs 6 pairs.\n"));
}

TEST_F(ProgramCompare, SaysWhatIsOfRanksAndWhatIsLeftOut) {
  // One large difference outweighs nine small ones in the mean, not in the ranks.
  WriteRuns("a", {1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
  WriteRuns("b", {1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, -20});
  const std::string metric = std::string(" --metric ") + kComparedScore;
  EXPECT_THAT(Program("compare a b" + metric).out, HasSubstr("not told apart\n"));
  WriteRuns("b", {1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2});
  EXPECT_THAT(Program("compare a b" + metric).out, HasSubstr("A better\n"));
  WriteRuns("c", std::vector<double>(14, 1.0));
  WriteRuns("d", {1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2, 2.1, 2.2, 2.3, -20});
  EXPECT_THAT(Program("compare c d" + metric).out,
              HasSubstr("A better by ranks, not by the mean\n"));
  const Outcome same = Program("compare a a --metric all");
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.err, HasSubstr("A and B are the same runs"));
  EXPECT_THAT(same.out, HasSubstr("1 score left out, the same on both sides in every pair: "
                                  "trajectory.est.mean_euclidean_m\n"));
  EXPECT_THAT(same.out, Not(HasSubstr("want of a partner")));
  EXPECT_THAT(Program("compare a d" + metric).out,
              HasSubstr("; left out for want of a partner: 0 runs of A, 4 of B\n"));
}

TEST_F(ProgramCompare, SaysWhichRowsRestOnFewerPairs) {
  WriteRuns("a", kA);
  WriteRuns("b", kB);
  EXPECT_THAT(Program("compare a b").out, Not(HasSubstr("fewer pairs")));
  for (const char* run : {"b/2", "b/5", "b/6"}) {
    Write(std::string(run) + "/metrics.json",
          R"({"trajectory": {"est": {"mean_euclidean_m": null}}})");
  }
  const Outcome outcome = Program("compare a b");
  EXPECT_THAT(outcome.out, HasSubstr("10 pairs"));
  EXPECT_THAT(outcome.out,
              HasSubstr("\nOn fewer pairs, as the score is not defined on both sides in the "
                        "others: trajectory.est.mean_euclidean_m (7 of 10 pairs)\n"));
  const auto json = nlohmann::json::parse(Program("compare a b --json").out);
  EXPECT_EQ(json["metrics"][kComparedScore]["undefined_pairs"], 3);
}

TEST_F(ProgramCompare, SaysHowManyPairsAllRowsTake) {
  const std::string scores =
      R"({{"trajectory": {{"est": {{"mean_euclidean_m": {0}}}}}, "map": {{"ssim": {0}}}}})";
  for (int seed = 1; seed <= 6; ++seed) {
    for (const auto& [side, value] : {std::pair("a", 1.0), std::pair("b", 2.0 + 0.1 * seed)}) {
      const std::string run = fmt::format("{}/{}", side, seed);
      std::filesystem::create_directories(Path(run));
      Write(run + "/run.yaml", fmt::format("scene: room\nseed: {}\n", seed));
      Write(run + "/metrics.json", fmt::format(fmt::runtime(scores), value));
    }
  }
  const Outcome outcome = Program("compare a b");
  EXPECT_THAT(outcome.out, HasSubstr("A better"));
  EXPECT_THAT(
      outcome.out,
      HasSubstr(
          "\n6 pairs are enough to test 1 row at once, all 2 rows need 7 pairs; the others are not "
          "tested. Choose the scores with --metric, before looking at any.\n"));
  const auto json = nlohmann::json::parse(Program("compare a b --json").out);
  EXPECT_EQ(json["metrics"]["map.ssim"]["verdict"], "not_tested");
  EXPECT_TRUE(json["metrics"]["map.ssim"]["p_holm"].is_null());
}

TEST_F(ProgramCompare, AnotherMappersRunsArePairedByWhatTheyState) {
  WriteRuns("a", kA);
  for (std::size_t i = 0; i < kB.size(); ++i) {
    const std::string run = fmt::format("other/{}", i);
    std::filesystem::create_directories(Path(run));
    Write(run + "/run.yaml", fmt::format("seed: {}\n", i + 1));
    Write(run + "/trajectory.json",
          fmt::format(R"({{"trajectory": {{"est": {{"mean_euclidean_m": {}}}}}}})", kB[i]));
    Write(run + "/map.json", R"({"map": {"chamfer_m": 0.1}})");
  }
  const Outcome table = Program("compare a other");
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("10 pairs, paired by seed\n"));
  EXPECT_THAT(table.out, HasSubstr("B better"));
  Write("other/3/map.json", R"({"trajectory": {"est": {"mean_euclidean_m": 0.2}}})");
  ExpectRefusal("compare a other",
                {"other/3/map.json", kComparedScore, "which another file of the run has too"});
}

TEST_F(ProgramCompare, Refusals) {
  WriteRuns("a", kA);
  WriteRuns("b", {0.1, 0.2});
  ExpectRefusal("compare a nowhere", {"nowhere", "no such folder"});
  ExpectRefusal("compare a .", {".", "no run with scores"});
  ExpectRefusal("compare a b --metric trajectory.est.mean_euclidian_m",
                {"mean_euclidian_m", "did you mean", kComparedScore});
  ExpectRefusal("compare a b --where seed", {"--where", "key.path=value"});
  ExpectRefusal("compare a b --where-b seed", {"--where-b: is 'seed'", "key.path=value"});
  ExpectRefusal("compare a b --where sed=1", {"sed", "'seed'"});
  ExpectRefusal("compare a b --where-a gain=1", {"no axis 'gain', must be one of ", "seed"});
  ExpectRefusal("compare a b --metric mean_euclidean_m", {"did you mean '", kComparedScore});
  ExpectRefusal("compare a b --where-a seed=77", {"seed = 77"});
  ExpectRefusal("compare a/0 b/1", {"shares no run"});
  Write("b/0/metrics.json", "{");
  ExpectRefusal("compare a b", {"b/0/metrics.json"});
  // Twice the same seed.
  std::filesystem::copy(Path("a/0"), Path("a/copy"), std::filesystem::copy_options::recursive);
  ExpectRefusal("compare a a", {"several runs that make the same pair: a/0 and a/copy (scene = "
                                "room, trajectory = walk, frames = 9, seed = 1); compare folders "
                                "of one run each"});
}

}  // namespace
}  // namespace depthgrid
