// Runs joined into pairs, and what is concluded from them.
#include "eval/compare/comparison.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "eval/statistics/metric_direction.h"
#include "mapper/core/error.h"
#include "tests/refusal.h"
#include "tests/statistics/ten_runs.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;

constexpr const char* kError = "trajectory.est.mean_euclidean_m";

// A sweep over gains and seeds 1, 2, ...; the error of each gain by seed.
SweepResults Sweep(const std::vector<std::pair<std::string, std::vector<double>>>& by_gain) {
  SweepResults table;
  table.folder = "sweep";
  table.parameters = {{"mapper.fusion.gain", {}, {}}, {"seed", {}, {}}};
  table.metrics = {{kError, {}}, {"map.ssim", {}}};
  for (const auto& [gain, errors] : by_gain) {
    for (std::size_t i = 0; i < errors.size(); ++i) {
      table.runs.push_back(static_cast<int>(table.rows()));
      table.points.push_back(0);
      table.failures.emplace_back();
      table.parameters[0].texts.push_back(gain);
      table.parameters[0].numbers.push_back(std::stod(gain));
      table.parameters[1].texts.push_back(std::to_string(i + 1));
      table.parameters[1].numbers.push_back(static_cast<double>(i + 1));
      table.metrics[0].values.push_back(errors[i]);
      table.metrics[1].values.push_back(1.0 - errors[i]);
    }
  }
  return table;
}

TEST(Compare, TwoSettingsOfOneSweep) {
  const SweepResults sweep = Sweep({{"0.25", kA}, {"0.50", kB}});
  CompareOptions options;
  options.where_a = {{"mapper.fusion.gain", "0.250"}};
  options.where_b = {{"mapper.fusion.gain", "0.5"}};
  const Comparison c = Compare(sweep, sweep, options);
  EXPECT_THAT(c.paired_by, ElementsAre("seed"));
  EXPECT_EQ(c.pairs, 10);
  ASSERT_EQ(c.metrics.size(), 2U);
  const MetricComparison& error = c.metrics[0];
  EXPECT_EQ(error.metric, kError);
  EXPECT_NEAR(error.paired.mean_difference, -0.0636, 1e-12);
  EXPECT_NEAR(error.paired.wilcoxon.p_value, 0.009765625, 1e-12);
  EXPECT_NEAR(error.p_holm, 2 * 0.009765625, 1e-12);  // of two tests
  EXPECT_EQ(error.verdict, Verdict::kBBetter);
  EXPECT_EQ(c.metrics[1].better, Better::kHigher);
  EXPECT_EQ(c.metrics[1].verdict, Verdict::kBBetter);
  std::swap(options.where_a, options.where_b);
  EXPECT_EQ(Compare(sweep, sweep, options).metrics[0].verdict, Verdict::kABetter);
}

TEST(Compare, PairsByAllAxesThatBothHave) {
  const SweepResults one = Sweep({{"0.25", kA}, {"0.5", kB}});
  const SweepResults two = Sweep({{"0.5", kA}, {"1", kB}});
  const Comparison c = Compare(one, two, {});
  EXPECT_THAT(c.paired_by, ElementsAre("mapper.fusion.gain", "seed"));
  EXPECT_EQ(c.pairs, 10);  // gain 0.5 alone is in both
  EXPECT_EQ(c.runs_a, 20);
  EXPECT_NEAR(c.metrics[0].paired.mean_a, 0.3282, 1e-12);
  EXPECT_NEAR(c.metrics[0].paired.mean_b, 0.3918, 1e-12);
}

// The same five seeds at five gains are no 25 seeds.
TEST(Compare, PairsOfOneSeedCountAsOne) {
  const std::vector<double> a(kA.begin(), kA.begin() + 5), b(kB.begin(), kB.begin() + 5);
  const Comparison seeds = Compare(Sweep({{"0.5", a}}), Sweep({{"0.5", b}}), {});
  std::vector<std::pair<std::string, std::vector<double>>> many_a, many_b;
  for (const char* gain : {"0.1", "0.2", "0.3", "0.4", "0.5"}) {
    many_a.emplace_back(gain, a);
    many_b.emplace_back(gain, b);
  }
  const Comparison c = Compare(Sweep(many_a), Sweep(many_b), {});
  EXPECT_EQ(c.pairs, 25);
  EXPECT_EQ(c.units, 5);
  EXPECT_EQ(c.metrics[0].paired.pairs, 5);
  EXPECT_NEAR(c.metrics[0].paired.wilcoxon.p_value, seeds.metrics[0].paired.wilcoxon.p_value,
              1e-12);
  EXPECT_EQ(c.metrics[0].verdict, Verdict::kTooFew);
}

// Two times two seeds are no four: differences that hang on the one or the other are seen twice.
TEST(Compare, CrossedSeedsCountAsManyAsOneOfThemHas) {
  SweepResults a, b;
  for (SweepResults* side : {&a, &b}) {
    side->folder = "sweep";
    side->parameters = {{"slam_seed", {}, {}}, {"depth_seed", {}, {}}};
    side->metrics = {{kError, {}}};
    for (int slam = 1; slam <= 8; ++slam) {
      for (int depth = 1; depth <= 9; ++depth) {
        side->runs.push_back(static_cast<int>(side->rows()));
        side->points.push_back(0);
        side->failures.emplace_back();
        side->parameters[0].texts.push_back(std::to_string(slam));
        side->parameters[1].texts.push_back(std::to_string(depth));
        for (SweepParameter& p : side->parameters) p.numbers.push_back(0.0);
        const double unlike = 1e-6 * slam;  // of 2 x 3 and 3 x 2
        side->metrics[0].values.push_back(side == &a ? 1.0 : 2.0 + 0.01 * slam * depth + unlike);
      }
    }
  }
  const Comparison c = Compare(a, b, {});
  EXPECT_EQ(c.pairs, 72);
  EXPECT_EQ(c.units, 8);
  EXPECT_THAT(c.crossed_seeds, ElementsAre("slam_seed", "depth_seed"));
  EXPECT_EQ(c.metrics[0].paired.pairs, 8);
  EXPECT_NEAR(c.metrics[0].paired.wilcoxon.p_value, 2.0 / 256, 1e-12);
}

// 2^53 + 1 and 2^53 are one number to a double.
TEST(Compare, LargeSeedsStayApart) {
  SweepResults a = Sweep({{"0.5", {1, 2}}});
  a.parameters[1].texts = {"9007199254740992", "9007199254740993"};
  a.parameters[1].numbers = {9007199254740992.0, 9007199254740992.0};
  CompareOptions options;
  EXPECT_EQ(Compare(a, a, options).pairs, 2);
  options.where_a = options.where_b = {{"seed", "9007199254740993"}};
  const Comparison c = Compare(a, a, options);
  EXPECT_EQ(c.pairs, 1);
  EXPECT_EQ(c.metrics[0].paired.mean_a, 2.0);
}

// A scale of 0.5 is as far from 1 as 1.5 is; a count has no better side, and `all` no row of it.
TEST(Compare, ScoresWithATargetAndWithoutADirection) {
  SweepResults a = Sweep({{"1", {0.5, 0.6, 0.7, 0.8, 0.4, 0.3}}});
  SweepResults b = Sweep({{"1", {1.1, 1.2, 0.9, 0.9, 1.1, 1.3}}});
  for (SweepResults* side : {&a, &b}) {
    side->metrics[0].name = "trajectory.est.sim3_scale";
    side->metrics[1].name = "map.navigability.pairs";
    side->metrics.push_back({"map.chamfer_m", std::vector<double>(6, 0.25)});
  }
  CompareOptions options;
  options.metrics = {"all"};
  const Comparison c = Compare(a, b, options);
  ASSERT_EQ(c.metrics.size(), 1U);
  EXPECT_EQ(c.metrics[0].target, 1.0);
  EXPECT_NEAR(c.metrics[0].paired.mean_a, 0.45, 1e-12);
  EXPECT_NEAR(c.metrics[0].paired.mean_b, 0.9 / 6, 1e-12);
  EXPECT_EQ(c.metrics[0].paired.b_wins, 6);
  EXPECT_EQ(c.metrics[0].verdict, Verdict::kBBetter);  // of one row; p = 2 / 64
  EXPECT_THAT(c.without_direction, ElementsAre("map.navigability.pairs"));
  EXPECT_THAT(c.all_equal, ElementsAre("map.chamfer_m"));
  options.metrics = {"map.navigability.pairs"};
  const Comparison asked = Compare(a, b, options);
  EXPECT_EQ(asked.metrics[0].better, Better::kNeither);
  EXPECT_EQ(asked.metrics[0].paired.a_wins + asked.metrics[0].paired.b_wins, 0);
  EXPECT_EQ(asked.metrics[0].verdict, Verdict::kAHigher);
  EXPECT_TRUE(asked.without_direction.empty());
}

// 0.9 and 1.1 are as far from 1, though not to the last digit.
TEST(Compare, ScoresAsFarFromTheirTargetAreEqual) {
  SweepResults a = Sweep({{"1", std::vector<double>(8, 0.9)}});
  SweepResults b = Sweep({{"1", std::vector<double>(8, 1.1)}});
  for (SweepResults* side : {&a, &b}) {
    side->metrics[0].name = "trajectory.est.sim3_scale";
    for (std::size_t i = 0; i < 8; ++i) side->metrics[1].values[i] = static_cast<double>(i);
  }
  CompareOptions options;
  options.metrics = {"trajectory.est.sim3_scale"};
  const Comparison c = Compare(a, b, options);
  EXPECT_EQ(c.metrics[0].paired.wilcoxon.zeros, 8);
  EXPECT_EQ(c.metrics[0].paired.a_wins, 0);
  EXPECT_EQ(c.metrics[0].paired.wilcoxon.p_value, 1.0);
  EXPECT_EQ(DistanceFrom(1.0, 1.0 + 1e-15), 0.0);
}

TEST(Compare, AScoreAskedForTwiceIsOneTest) {
  CompareOptions options;
  options.metrics = {kError, kError};
  const Comparison c = Compare(Sweep({{"1", kA}}), Sweep({{"1", kB}}), options);
  ASSERT_EQ(c.metrics.size(), 1U);
  EXPECT_EQ(c.metrics[0].p_holm, c.metrics[0].paired.wilcoxon.p_value);
}

// Rooms of one seed are all that varies.
TEST(Compare, OfOneSeedEachPairCounts) {
  std::vector<std::pair<std::string, std::vector<double>>> one_a, one_b;
  for (std::size_t i = 0; i < kA.size(); ++i) {
    one_a.push_back({std::to_string(i), {kA[i]}});
    one_b.push_back({std::to_string(i), {kB[i]}});
  }
  EXPECT_EQ(Compare(Sweep(one_a), Sweep(one_b), {}).units, 10);
}

TEST(Compare, FailedRunsAndUndefinedScoresMakeNoPair) {
  SweepResults a = Sweep({{"0.25", kA}});
  const SweepResults b = Sweep({{"0.25", kB}});
  a.failures[3] = "no pose";
  a.metrics[0].values[5] = NAN;
  const Comparison c = Compare(a, b, {});
  EXPECT_EQ(c.pairs, 9);
  EXPECT_EQ(c.metrics[0].paired.pairs, 8);
  EXPECT_EQ(c.metrics[0].undefined_pairs, 1);
  EXPECT_EQ(c.metrics[1].undefined_pairs, 0);
  EXPECT_EQ(c.metrics[1].paired.pairs, 9);
  // A score that is defined in no pair is named, not only missing.
  a.metrics[0].values.assign(a.rows(), NAN);
  EXPECT_THAT(Compare(a, b, {}).undefined, ElementsAre(kError));
  // So is one that a side knows nothing of, whichever that is.
  a.metrics.erase(a.metrics.begin());
  EXPECT_THAT(Compare(a, b, {}).undefined, ElementsAre(kError));
  EXPECT_THAT(Compare(b, a, {}).undefined, ElementsAre(kError));
  CompareOptions all;
  all.metrics = {"all"};
  EXPECT_THAT(Compare(a, b, all).undefined, ElementsAre(kError));
  EXPECT_THAT(Compare(b, a, all).undefined, ElementsAre(kError));
}

// Six runs of what does not hang on the seed are one measurement: no test tells it from chance.
TEST(Compare, SeedsThatChangeNothingAreOne) {
  SweepResults table =
      Sweep({{"0", std::vector<double>(6, 0.4)}, {"1", std::vector<double>(6, 0.1)}});
  CompareOptions options;
  options.where_a = {{"mapper.fusion.gain", "0"}};
  options.where_b = {{"mapper.fusion.gain", "1"}};
  const Comparison c = Compare(table, table, options);
  EXPECT_EQ(c.repeated_seeds, 5);
  EXPECT_EQ(c.units, 1);
  EXPECT_EQ(c.metrics[0].verdict, Verdict::kTooFew);
  // One score of one run that differs makes a seed another one.
  table.metrics[1].values[2] += 1e-9;
  EXPECT_EQ(Compare(table, table, options).repeated_seeds, 4);
}

// As the sweep's file has it, not as the table spells it; a slip is told what there is.
TEST(Compare, ConditionsTakeValuesAsTheyAreWritten) {
  SweepResults table = Sweep({{"0", kA}, {"1", kB}});
  for (std::size_t row = kA.size(); row < table.rows(); ++row) {
    table.parameters[0].texts[row] = "[1, 1, 0]";
  }
  CompareOptions options;
  options.where_a = {{"mapper.fusion.gain", "0.0"}};
  options.where_b = {{"mapper.fusion.gain", "[1,1,0]"}};
  EXPECT_EQ(Compare(table, table, options).pairs, 10);
  options.where_b = {{"mapper.fusion.gain", "0.3"}};
  EXPECT_EQ(RefusalOf([&] { Compare(table, table, options); }),
            "sweep: no run has mapper.fusion.gain = 0.3, there are 0, [1, 1, 0]");
}

TEST(Compare, FewPairsCannotDecide) {
  const Comparison c =
      Compare(Sweep({{"1", {1, 2, 3, 4, 5}}}), Sweep({{"1", {2, 3, 4, 5, 6}}}), {});
  EXPECT_EQ(c.metrics[0].verdict, Verdict::kTooFew);
  const Comparison equal = Compare(Sweep({{"1", kA}}), Sweep({{"1", kA}}), {});
  EXPECT_EQ(equal.metrics[0].verdict, Verdict::kNotToldApart);
  EXPECT_EQ(equal.metrics[0].seeds_needed, std::nullopt);
}

// Holm takes the smallest p-value of 7 pairs, 2 / 2^7, times the number of rows: three can fall
// below 5 %, four cannot.
TEST(Compare, FewPairsCannotDecideManyRows) {
  SweepResults a = Sweep({{"1", {1, 2, 3, 4, 5, 6, 7}}});
  SweepResults b = Sweep({{"1", {2.1, 3, 4, 5, 6, 7, 8}}});
  CompareOptions options;
  options.metrics = {"all"};
  const auto with_rows = [&](std::size_t rows) {
    for (SweepResults* side : {&a, &b}) {
      side->metrics.resize(rows, side->metrics[0]);
      for (std::size_t i = 0; i < rows; ++i) side->metrics[i].name = fmt::format("{}_m", i);
    }
    return Compare(a, b, options);
  };
  const Comparison three = with_rows(3);
  EXPECT_NEAR(three.metrics[0].p_holm, 3.0 / 64, 1e-12);
  EXPECT_EQ(three.metrics[0].verdict, Verdict::kABetter);
  EXPECT_EQ(three.metrics[0].seeds_needed, 7);
  EXPECT_EQ(three.most_rows, 3);
  const Comparison four = with_rows(4);
  EXPECT_NEAR(four.metrics[0].p_holm, 4.0 / 64, 1e-12);
  EXPECT_EQ(four.metrics[0].verdict, Verdict::kTooFew);
  EXPECT_EQ(four.metrics[0].seeds_needed, 8);
  EXPECT_EQ(four.most_rows, 3);
}

// Six pairs, all of one sign, give p = 2 / 2^6 = 0.031: one row. Of the headlines it is the first
// that differs at all; what is asked for is tested whole.
TEST(Compare, OfTheHeadlinesAsManyAreTestedAsThePairsCanTellApart) {
  SweepResults a = Sweep({{"1", {1, 2, 3, 4, 5, 6}}});
  SweepResults b = Sweep({{"1", {2, 3, 4, 5, 6, 7}}});
  const Comparison c = Compare(a, b, {});
  EXPECT_EQ(c.metrics[0].verdict, Verdict::kABetter);
  EXPECT_NEAR(c.metrics[0].p_holm, 1.0 / 32, 1e-12);
  EXPECT_EQ(c.metrics[1].verdict, Verdict::kNotTested);
  EXPECT_EQ(c.most_rows, 1);
  EXPECT_EQ(c.pairs_for_one, 6);
  EXPECT_EQ(c.pairs_for_all, 7);  // 2 * 2 / 2^7 = 0.031
  CompareOptions both;
  both.metrics = {kError, "map.ssim"};
  EXPECT_EQ(Compare(a, b, both).metrics[0].verdict, Verdict::kTooFew);
  a.metrics[0].values = b.metrics[0].values;
  const Comparison second = Compare(a, b, {});
  EXPECT_EQ(second.metrics[0].verdict, Verdict::kNotToldApart);  // equal: there is nothing to test
  EXPECT_EQ(second.metrics[1].verdict, Verdict::kABetter);
  for (const MetricComparison& row : Compare(a, a, {}).metrics) {
    EXPECT_EQ(row.verdict, Verdict::kNotToldApart);
  }
}

// By their sizes six such differences are enough, by the ranks of these the p-value is 4 / 2^6.
TEST(Compare, WhatIsNotToldApartNeedsMoreThanThereIs) {
  const std::vector<double> zero(6, 0.0);
  CompareOptions options;
  options.metrics = {kError};
  const Comparison c =
      Compare(Sweep({{"1", zero}}), Sweep({{"1", {-.01, 3, 3.1, 3.2, 3.3, 3.4}}}), options);
  EXPECT_EQ(c.metrics[0].verdict, Verdict::kNotToldApart);
  EXPECT_EQ(c.metrics[0].seeds_needed, 7);
}

}  // namespace
}  // namespace depthgrid
