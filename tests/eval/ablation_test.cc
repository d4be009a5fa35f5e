// `depthgrid ablate`: shares worked by hand, and the program on a tiny room.
#include "eval/study/ablation.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/eval/browser.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

TEST(Ablation, SharesAreDifferencesFromWhatEachIsComparedWith) {
  // Errors of two seeds; everything else of no effect.
  const std::map<std::string, std::array<double, 2>> errors = {
      {"as_it_is", {1.0, 3.0}},  {"poses", {0.5, 1.5}},   {"depth", {0.8, 2.8}},
      {"converter", {0.6, 2.4}}, {"matcher", {1.0, 3.0}}, {"loops", {1.2, 3.2}},
      {"all", {0.0, 0.0}}};
  std::vector<AblationRun> runs;
  for (const AblationVariant& variant : AblationVariants()) {
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      runs.push_back({variant.name,
                      seed,
                      {{"trajectory.est.mean_euclidean_m", errors.at(variant.name)[seed]},
                       {"map.observable.occupied.f1", 1.0 - errors.at(variant.name)[seed]},
                       {"map.chamfer_m", NAN}}});
    }
  }
  const std::vector<ErrorShares> shares = SharesOf(runs);
  ASSERT_EQ(shares.size(), 2U);  // the chamfer distance is not defined
  for (const ErrorShares& score : shares) {
    EXPECT_EQ(score.is_complement, score.metric.ends_with("f1"));
    EXPECT_NEAR(score.error, 2.0, 1e-12);
    std::map<std::string, double> share;
    for (const StageShare& stage : score.stages) share[stage.variant] = stage.share.value();
    EXPECT_NEAR(share.at("poses"), 0.5, 1e-12);
    EXPECT_NEAR(share.at("depth"), 0.1, 1e-12);
    EXPECT_NEAR(share.at("converter"), 0.15, 1e-12);  // beyond what exact depth gives
    EXPECT_NEAR(share.at("matcher"), 0.0, 1e-12);
    EXPECT_NEAR(share.at("loops"), -0.1, 1e-12);
    EXPECT_NEAR(share.at("all"), 1.0, 1e-12);
  }
}

// What rounding leaves: of true poses put in 2e-16 m, of 0.1 + 0.2 a last digit that 0.3 has not,
// and of differences that cancel.
TEST(SharesOf, WhatRoundingLeavesIsNothing) {
  const std::map<std::string, std::array<double, 6>> errors = {
      {"poses", {2e-16, 2e-16, 2e-16, 2e-16, 2e-16, 2e-16}},
      {"depth", {0.3, 0.3, 0.3, 0.3, 0.3, 0.3}},
      {"matcher", {0.4, 0.2, 0.35, 0.25, 0.31, 0.29}}};
  std::vector<AblationRun> runs;
  for (const AblationVariant& variant : AblationVariants()) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const auto found = errors.find(variant.name);
      const double error = found == errors.end() ? 0.1 + 0.2 : found->second[seed];
      runs.push_back({variant.name, seed, {{"map.chamfer_m", error}}});
    }
  }
  ASSERT_NE(0.1 + 0.2, 0.3);
  const std::vector<ErrorShares> shares = SharesOf(runs);
  ASSERT_EQ(shares.size(), 1U);
  std::map<std::string, StageShare> stages;
  for (const StageShare& stage : shares[0].stages) stages[stage.variant] = stage;
  EXPECT_EQ(stages.at("poses").error, 0.0);
  EXPECT_EQ(stages.at("matcher").gain.mean_difference, 0.0);
  EXPECT_EQ(stages.at("depth").gain.mean_difference, 0.0);
  EXPECT_EQ(stages.at("depth").share, 0.0);
  EXPECT_EQ(stages.at("depth").gain.wilcoxon.p_value, 1.0);  // six seeds alike are 0.03
  EXPECT_EQ(AblationJson(shares, 6, "room").find("e-1"), std::string::npos);
  EXPECT_EQ(AblationJson(shares, 6, "room").find("-0.0\n"), std::string::npos);
}

TEST(SharesOf, OfNoErrorAreNone) {
  std::vector<AblationRun> runs;
  for (const AblationVariant& variant : AblationVariants()) {
    runs.push_back({variant.name, 1, {{"map.observable.occupied.f1", 1.0}}});
  }
  const std::vector<ErrorShares> shares = SharesOf(runs);
  ASSERT_EQ(shares.size(), 1U);
  for (const StageShare& stage : shares[0].stages) EXPECT_FALSE(stage.share) << stage.variant;
  EXPECT_NE(AblationJson(shares, 1, "room").find(R"("share": null)"), std::string::npos);
}

// Seeds 1 and 3 give the same everywhere; of seed 2 one variant differs.
TEST(WithoutRepeatedSeeds, KeepsWhatIsNew) {
  std::vector<AblationRun> runs;
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const char* variant : {"as_it_is", "poses"}) {
      const bool differs = seed == 2 && std::string(variant) == "poses";
      runs.push_back({variant, seed, {{"map.coverage", differs ? 0.5 : 1.0}, {"map.ssim", NAN}}});
    }
  }
  const std::vector<AblationRun> kept = WithoutRepeatedSeeds(runs);
  ASSERT_EQ(kept.size(), 4U);
  EXPECT_EQ(kept[1].seed, 1U);
  EXPECT_EQ(kept[3].seed, 2U);
}

class ProgramAblate : public ProgramTest {};

TEST_F(ProgramAblate, SeedsThatChangeNothingAreOneMeasurement) {
  const Outcome outcome = Program(
      "ablate ./small.yaml --seeds 3 --set slam_seed=1 --set depth_seed=1 -o out --threads 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err,
            "depthgrid: warning: 2 of 3 seeds give the same scores as another and do not count: "
            "nothing here depends on the seed\n");
  EXPECT_THAT(outcome.out, testing::StartsWith("./small.yaml: 21 runs, 7 variants x 3 seeds\n"));
  EXPECT_THAT(outcome.out, HasSubstr("1 seed;"));
  EXPECT_FALSE(std::filesystem::exists(Path("out/cache")));
  EXPECT_EQ(nlohmann::json::parse(ReadFile(Path("out/ablation.json")))["seeds"], 1);
  const std::string csv = ReadFile(Path("out/ablation.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 7);  // as they were run
}

TEST(AblationCsv, HasTheScoresOfEveryRun) {
  const std::vector<AblationRun> runs = {{"a", 1, {{"x", 1.0}}},
                                         {"b", 1, {{"x", 2.0}, {"y", 3.0}}}};
  EXPECT_EQ(AblationCsv(runs), "variant,seed,x,y\na,1,1,\nb,1,2,3\n");
}

TEST_F(ProgramAblate, WritesTheSameTableAtAnyNumberOfThreads) {
  const Outcome first = Program("ablate ./small.yaml --seeds 2 --threads 1 -o one");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("2 seeds"));
  EXPECT_THAT(first.out, HasSubstr("matched poses are true"));
  // Lengths have their unit, shares none.
  EXPECT_THAT(first.out, testing::ContainsRegex("mean_euclidean_m: [0-9.e-]+ m as it is\ntruth "
                                                "for +error m +owned m +95 % interval m  "));
  EXPECT_THAT(first.out, testing::ContainsRegex("occupied.f1: [0-9.e-]+ as it is\ntruth for +error "
                                                " +owned +95 % interval  "));
  const Outcome second = Program("ablate ./small.yaml --seeds 2 --threads 2 --json -o two");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_TRUE(SameFile("one/ablation.csv", "two/ablation.csv"));
  EXPECT_EQ(second.out, ReadFile(Path("one/ablation.json")));
  const auto json = nlohmann::json::parse(second.out);
  const auto& online = json["scores"]["trajectory.online.mean_euclidean_m"];
  // The truth everywhere leaves no error of the poses; every row of the table is there.
  EXPECT_LT(online["truth_for"]["all"]["error"].get<double>(), 1e-4);
  EXPECT_GT(online["error"].get<double>(), 1e-4);
  const std::string csv = ReadFile(Path("one/ablation.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 7);
}

// A sensor that errs in nothing but sees 4.5 m far, in a hall of 8 m.
TEST_F(ProgramAblate, ExactDepthKeepsTheRangeOfTheSensor) {
  Write("hall.yaml", R"(
name: hall
shapes:
  - {shape: box, size: [3, 8, 0.1], at: [1.5, 4, -0.1]}
  - {shape: wall, from: [0, 0], to: [3, 0], side: right}
  - {shape: wall, from: [3, 0], to: [3, 8], side: right}
  - {shape: wall, from: [3, 8], to: [0, 8], side: right}
  - {shape: wall, from: [0, 8], to: [0, 0], side: right}
trajectories:
  along: {kind: handheld, waypoints: [{at: [1.5, 2, 1.1], look_at: [1.5, 8, 1]},
                                      {at: [1.6, 3, 1.1], look_at: [1.5, 8, 1]}]}
)");
  Succeed(
      "ablate ./small.yaml --seeds 1 --set scene=./hall.yaml --set sensor.noise=kinect_v2 "
      "--set sensor.noise_scale=0 --set sensor.grazing_limit_deg=90 -o out");
  std::map<std::string, std::string> scores;  // of each variant
  std::istringstream lines(ReadFile(Path("out/ablation.csv")));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comma = line.find(',');
    scores[line.substr(0, comma)] = line.substr(comma);
  }
  EXPECT_EQ(scores.at("depth"), scores.at("as_it_is"));
  EXPECT_NE(scores.at("converter"), scores.at("as_it_is"));
}

TEST_F(ProgramAblate, ItsPageShowsEveryStageOfEveryScore) {
  Succeed("ablate ./small.yaml --seeds 2 -o out");
  const std::string page = ReadFile(Path("out/report.html"));
  std::filesystem::remove(Path("out/report.html"));
  EXPECT_EQ(Program("report out").out, "look at out/report.html\n");
  EXPECT_EQ(Difference(page, ReadFile(Path("out/report.html"))), "");
  const auto json = nlohmann::json::parse(ReadFile(Path("out/ablation.json")));
  Write("out/ablation.json", "{}");
  const Outcome broken = Program("report out");
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_EQ(broken.err, "depthgrid: out/ablation.json: is no ablation's result\n");
  const std::optional<std::string> chromium = FindChromium();
  if (!chromium) GTEST_SKIP() << "no chromium on this machine";
  Browser browser(*chromium, root_.string() + "_browser");
  browser.Open(Path("out/report.html"));
  EXPECT_THAT(browser.problems(), ::testing::IsEmpty());
  EXPECT_EQ(browser.Evaluate("document.querySelectorAll('#scores table').length"),
            json["scores"].size());
  EXPECT_EQ(browser.Evaluate("document.querySelectorAll('#scores tbody tr').length"),
            6 * json["scores"].size());
  EXPECT_THAT(browser.Evaluate("document.body.innerText").get<std::string>(),
              HasSubstr("matched poses are true"));
  // Of the first score, which is a length, and of one that is none.
  const auto heads_of = [&](const std::string& title) {
    return browser
        .Evaluate(
            "(() => { const h = [...document.querySelectorAll('#scores h3')].find((e) => "
            "e.textContent.startsWith('" +
            title +
            "')); return [...h.nextElementSibling."
            "querySelectorAll('th')].map((th) => th.textContent).join('; '); })()")
        .get<std::string>();
  };
  EXPECT_THAT(heads_of("trajectory.est.mean_euclidean: "),
              HasSubstr("truth for; share; 0100 %; error (mm); owned (mm); 95 % interval (mm); p"));
  EXPECT_THAT(heads_of("1 − map.observable.occupied.f1"),
              HasSubstr("error; owned; 95 % interval; p"));
  EXPECT_THAT(browser.Evaluate("document.getElementById('subtitle').textContent"),
              HasSubstr("prove nothing): test_room, 12 frames, SLAM orb_slam2, "));
  EXPECT_EQ(browser.Evaluate("document.querySelector('h1').textContent"), "Ablation of test_room");
  EXPECT_EQ(browser.Evaluate("document.querySelectorAll('#scores h3 .save button').length"),
            json["scores"].size());
  EXPECT_THAT(browser.Evaluate("csvOfScore([['a_b', {share: 0.25, error: 0.003, owned: 0.001, "
                               "p_holm: 1}]], {unit: 'mm', factor: 1000})"),
              "truth for,share,error (mm),owned (mm),\"owned, 95 % low (mm)\",\"owned, 95 % high "
              "(mm)\",p (Holm)\na b,0.25,3,1,,,1\n");
  browser.Open(Path("out/report.html"), 400);
  // The labels of each scale lie on it, and apart, wherever 0 and all of the error are.
  EXPECT_EQ(
      browser.Evaluate(
          "[0, 1, 9, 20, 150, 239].flatMap((zero) => [zero + 1, 30, 120, 239].map((all) => { "
          "const s = scaleHead((share) => share ? all : zero); "
          "document.body.append(s); const box = s.getBoundingClientRect(); const [a, b] = "
          "[...s.querySelectorAll('text')].map((t) => t.getBoundingClientRect()); s.remove(); "
          "return a.right < b.left && a.left >= box.left && b.right <= box.right; "
          "})).includes(false)"),
      false);
  EXPECT_LE(browser.Evaluate("document.documentElement.scrollWidth - innerWidth").get<int>(), 0);
}

TEST_F(ProgramAblate, Refusals) {
  for (const char* arguments :
       {"ablate ./nothing.yaml -o out", "ablate ./small.yaml --seeds 0 -o out",
        "ablate ./small.yaml", "ablate ./small.yaml --set framse=3 -o out"}) {
    const Outcome outcome = Program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(Path("out")));
  }
  EXPECT_EQ(Program("ablate ./small.yaml --seeds 2 --first-seed 18446744073709551615 -o out").err,
            "depthgrid: --first-seed: 2 seeds from 18446744073709551615 on go beyond "
            "18446744073709551615, the largest there is\n");
  // Each run has its own.
  EXPECT_EQ(Program("ablate ./small.yaml --set seed=4 -o out").err,
            "depthgrid: --set seed=4: give --first-seed N\n");
}

}  // namespace
}  // namespace depthgrid
