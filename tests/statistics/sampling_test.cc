#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "eval/metrics/statistics.h"
#include "eval/statistics/best_setting.h"
#include "eval/statistics/distributions.h"
#include "eval/statistics/sample_size.h"
#include "eval/statistics/sample_summary.h"
#include "mapper/core/angle.h"
#include "tests/statistics/ten_runs.h"

namespace depthgrid {
namespace {

// np.mean, np.median, np.std(ddof=1); the interval from 200,000 resamples (SciPy 1.10.1):
//   scipy.stats.bootstrap((a,), np.mean, n_resamples=200000, method='percentile', random_state=1)
// The standard error of a 2.5 % quantile of 10,000 draws is sqrt(.025 * .975 / 10000) / density,
// here 0.0006.
TEST(Sample, MeanWithItsIntervalAndMedian) {
  const SampleSummary s = SummariseSample(kA, Resamples(kA.size()));
  EXPECT_EQ(s.count, 10);
  EXPECT_NEAR(s.mean, 0.3918, 1e-15);
  EXPECT_NEAR(s.median, 0.398, 1e-15);
  EXPECT_NEAR(s.std, 0.07610635832686898, 1e-15);
  EXPECT_NEAR(s.mean_interval->low, 0.3469, 0.002);
  EXPECT_NEAR(s.mean_interval->high, 0.4364, 0.002);
}

TEST(Sample, OneValueHasNoInterval) {
  const SampleSummary s = SummariseSample({0.4}, Resamples(1));
  EXPECT_EQ(s.mean, 0.4);
  EXPECT_EQ(s.std, 0.0);
  EXPECT_FALSE(s.mean_interval);
}

TEST(Resamples, TheSameForTheSameSeedAndEvenlySpread) {
  const Resamples one(7), again(7), other(7, {.seed = 2});
  std::vector<int> drawn(7, 0);
  bool differs = false;
  for (int i = 0; i < one.count(); ++i) {
    ASSERT_EQ(one[i].size(), 7U);
    ASSERT_TRUE(std::equal(one[i].begin(), one[i].end(), again[i].begin()));
    differs = differs || !std::equal(one[i].begin(), one[i].end(), other[i].begin());
    for (const auto index : one[i]) ++drawn.at(index);
  }
  EXPECT_TRUE(differs);
  for (const int count : drawn) EXPECT_NEAR(count, 10000, 4 * 100);  // 4 standard deviations
}

// The figures of given resamples, one after the other, against the definition.
TEST(Resamples, FiguresAreOfTheirIndices) {
  const Resamples resamples(3, {.resamples = 20});
  const std::vector<double> values = {1.0, 10.0, 100.0};
  const auto sums = FiguresOf(resamples, [&](std::span<const std::uint32_t> at) {
    return values[at[0]] + values[at[1]] + values[at[2]];
  });
  std::vector<double> means;
  for (const double sum : sums) means.push_back(sum / 3.0);
  const auto interval = MeanInterval(values, resamples);
  EXPECT_NEAR(interval->low, Percentile(means, 0.025), 1e-12);
  EXPECT_NEAR(interval->high, Percentile(means, 0.975), 1e-12);
}

// scipy.stats.bootstrap((b - a,), np.mean, n_resamples=200000, method='percentile', ...)
TEST(Paired, DifferenceIntervalAndWins) {
  const PairedComparison c = ComparePaired(kA, kB, Better::kLower, Resamples(kA.size()));
  EXPECT_EQ(c.pairs, 10);
  EXPECT_NEAR(c.mean_difference, -0.0636, 1e-15);
  EXPECT_NEAR(c.median_difference, -0.043, 1e-15);
  EXPECT_NEAR(c.std_difference, 0.06577774024022955, 1e-15);
  EXPECT_NEAR(c.mean_interval->low, -0.1036, 0.002);
  EXPECT_NEAR(c.mean_interval->high, -0.0264, 0.002);
  EXPECT_EQ(c.b_wins, 8);
  EXPECT_EQ(c.a_wins, 2);
  EXPECT_NEAR(c.wilcoxon.p_value, 0.009765625, 1e-15);
  EXPECT_EQ(ComparePaired(kA, kB, Better::kHigher, Resamples(kA.size())).a_wins, 8);
}

// scipy.stats.t.cdf(x, df), t.ppf(.975, df), nct.cdf(x, df, 1.7) at x = -2, .5, 3
// Shares of 40 plans: of 30 / 40 - 29 / 40 and 36 / 40 - 35 / 40 only the integers tell that they
// are as large. The p-value is that of the counts' differences, whose ties are exact (the command
// stands at Wilcoxon.TiesAndZeros).
TEST(Paired, SharesThatAreTiedAsCountsAreTied) {
  const std::vector<double> a = {24, 30, 31, 35, 33, 33, 35, 22, 20, 20, 23, 20};
  const std::vector<double> b = {25, 31, 32, 36, 33, 32, 39, 22, 20, 22, 22, 23};
  std::vector<double> counts, share_a, share_b;
  for (std::size_t i = 0; i < a.size(); ++i) {
    counts.push_back(b[i] - a[i]);
    share_a.push_back(a[i] / 40.0);
    share_b.push_back(b[i] / 40.0);
  }
  const PairedComparison c =
      ComparePaired(share_a, share_b, Better::kHigher, Resamples(share_a.size()));
  EXPECT_NEAR(c.wilcoxon.p_value, 0.08984375, 1e-15);
  EXPECT_EQ(c.wilcoxon.p_value, Wilcoxon(counts).p_value);
  EXPECT_EQ(c.wilcoxon.rank_biserial, Wilcoxon(counts).rank_biserial);
}

TEST(Paired, WhatRoundingLeavesIsNoWin) {
  const std::vector<double> a(8, 0.07071067811865465), b(8, 0.07071067811865463);
  const PairedComparison c = ComparePaired(a, b, Better::kLower, Resamples(8));
  EXPECT_EQ(c.a_wins + c.b_wins, 0);
  EXPECT_EQ(c.wilcoxon.zeros, 8);
  EXPECT_EQ(c.mean_difference, 0.0);
}

TEST(Paired, DifferencesThatCancelLeaveNoRounding) {
  const std::vector<double> a = {0.95, 0.9, 0.85, 0.7}, b = {0.9, 0.95, 0.75, 0.8};
  EXPECT_EQ(ComparePaired(a, b, Better::kHigher, Resamples(4)).mean_difference, 0.0);
}

TEST(BestSetting, WhatRoundingLeavesMakesNoneTheBest) {
  const std::vector<SettingRuns> runs = {{0.0, std::vector<double>(8, 0.07071067811865465)},
                                         {1.0, std::vector<double>(8, 0.07071067811865463)}};
  const BestSetting best = FindBestSetting(runs, Better::kLower, Resamples(8));
  EXPECT_EQ(best.index, 0U);  // the first on ties
  EXPECT_TRUE(best.is_alike);
  EXPECT_NEAR(best.share_best[0], 0.5, 1e-12);
  EXPECT_NEAR(best.share_best[1], 0.5, 1e-12);
  EXPECT_EQ(best.setting_interval.low, 0.0);
  EXPECT_EQ(best.setting_interval.high, 1.0);
  EXPECT_EQ(best.p_as_good[1], 1.0);
}

TEST(StudentT, AgreesWithSciPy) {
  struct Case {
    double df, central[3], quantile, shifted[3];
  };
  const Case cases[] = {{1,
                         {0.1475836176504332, 0.6475836176504333, 0.8975836176504333},
                         12.706204736432095,
                         {0.007083123142557141, 0.10676299292961258, 0.5860635221488646}},
                        {4,
                         {0.05805826175840775, 0.6783350184090684, 0.9800290159641406},
                         2.7764451051977987,
                         {0.0011194294401189818, 0.11269119083165799, 0.7799585643498849}},
                        {19,
                         {0.030001018193049168, 0.6885917543567792, 0.9963191379080657},
                         2.093024054408263,
                         {0.0002275472731385546, 0.11455975461136898, 0.8719821647122928}},
                        {200,
                         {0.023426593093535494, 0.6911876238417696, 0.998478476443047},
                         1.9718962236316089,
                         {0.00011694784657002719, 0.11502113101607045, 0.9000692538305224}}};
  const double at[] = {-2.0, 0.5, 3.0};
  for (const Case& c : cases) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(StudentTCdf(at[i], c.df), c.central[i], 1e-9) << c.df << " " << at[i];
      EXPECT_NEAR(StudentTCdf(at[i], c.df, 1.7), c.shifted[i], 1e-9) << c.df << " " << at[i];
    }
    EXPECT_NEAR(StudentTQuantile(0.975, c.df), c.quantile, 1e-6 * c.quantile) << c.df;
  }
}

// Of one and two degrees large values are usual. Closed forms; the shifted ones by a midpoint sum
// over 800,000 cells that grow with the cube of their number.
TEST(StudentT, OfOneAndTwoDegreesAtLargeValues) {
  EXPECT_NEAR(StudentTCdf(1e6, 1), 1.0 - 1e-6 / kPi, 1e-15);
  EXPECT_NEAR(StudentTCdf(-7.0, 2), 0.5 - 3.5 / std::sqrt(51.0), 1e-15);
  EXPECT_NEAR(StudentTQuantile(1.0 - 0.025 / 13, 1), 165.51912696922403, 1e-8);
  EXPECT_NEAR(StudentTCdf(300, 1, 1.7), 0.9954300650519, 1e-9);
  EXPECT_NEAR(StudentTCdf(-40, 1, 1.7), 0.0003647602554003, 1e-9);
  EXPECT_NEAR(StudentTCdf(60, 2, 5), 0.9928077000767, 1e-9);
  EXPECT_NEAR(StudentTCdf(25, 3, 4), 0.9934928122603, 1e-9);
}

// c = t.ppf(.975, n - 1); nct.sf(c, n - 1, e * sqrt(n)) + nct.cdf(-c, n - 1, e * sqrt(n)); the
// smallest n with at least .8. (34 and 199 are also the textbook's for d = 0.5 and 0.2.)
TEST(SampleSize, AgreesWithSciPy) {
  EXPECT_NEAR(PairedPower(5, 1.0), 0.40138991737179386, 1e-8);
  EXPECT_NEAR(PairedPower(20, 0.5), 0.564504418439038, 1e-8);
  EXPECT_NEAR(PairedPower(100, -0.2), 0.5082648066516795, 1e-8);
  EXPECT_EQ(SeedsNeeded(2.0, 1.0), 5);
  EXPECT_EQ(SeedsNeeded(0.01, 0.01), 10);
  EXPECT_EQ(SeedsNeeded(-0.5, 1.0), 34);
  EXPECT_EQ(SeedsNeeded(0.2, 1.0), 199);
  EXPECT_EQ(SeedsNeeded(0.05, 1.0), 3142);
  EXPECT_FALSE(SeedsNeeded(0.00278, 1.0));  // 1,015,600
  EXPECT_EQ(SeedsNeeded(1.0, 0.0), 2);
  EXPECT_EQ(SeedsNeeded(1e-5, 1.0), std::nullopt);
  EXPECT_EQ(SeedsNeededByRanks(0.5, 1.0), 36);  // ceil(34 * pi / 3)
  EXPECT_EQ(SeedsNeededByRanks(1e-5, 1.0), std::nullopt);
  // Always seen, once 2 / 2^n is below the level.
  EXPECT_EQ(SeedsNeededByRanks(1.0, 0.0), 6);
  EXPECT_EQ(SeedsNeededByRanks(1.0, 0.0, {.level = 0.05 / 13}), 10);
}

TEST(BestSetting, HandWorked) {
  const std::vector<SettingRuns> runs = {
      {0.0, {4, 5, 6, 5}}, {0.5, {1, 2, 3, 1}}, {1.0, {2, 1, 4, 3}}};
  const BestSetting best = FindBestSetting(runs, Better::kLower, Resamples(4));
  EXPECT_EQ(best.setting, 0.5);
  EXPECT_EQ(best.share_best[0], 0.0);  // worse for every seed
  // The sums of the other two differ by -1, 1, -1, -2: 1.0 wins when seed 1 is drawn more than the
  // sum of the others wants, which is at least three of four draws: (4 * 3 + 1) / 256 = 5.1 %;
  // two of seed 1 and two of seeds 0 or 2 tie: half of 6 * 2 * 2 / 256.
  EXPECT_FALSE(best.is_alike);
  EXPECT_NEAR(best.share_best[2], (13.0 + 12.0) / 256.0, 0.01);
  EXPECT_EQ(best.setting_interval.low, 0.5);
  EXPECT_EQ(best.setting_interval.high, 1.0);
  EXPECT_NEAR(best.regret_mean[0], 3.25, 1e-12);
  EXPECT_EQ(best.regret_mean[1], 0.0);
  EXPECT_NEAR(best.regret_mean[2], 0.75, 1e-12);
  EXPECT_EQ(best.p_as_good[1], 1.0);
  EXPECT_NEAR(best.p_as_good[0], 0.25, 1e-12);  // 2 * 2/16, times two for Holm
  const std::vector<double> oracle = BestOfEachSeed(runs, Better::kLower);
  EXPECT_EQ(oracle, (std::vector<double>{1, 1, 3, 1}));
  EXPECT_EQ(Regret(runs[2].by_seed, oracle, Better::kLower), (std::vector<double>{1, 0, 1, 2}));
  EXPECT_EQ(FindBestSetting(runs, Better::kHigher, Resamples(4)).setting, 0.0);
}

TEST(BestSetting, NoneIsBestWhereNeitherMoreNorLessIsBetter) {
  const std::vector<SettingRuns> runs = {{0.0, {4, 5}}, {1.0, {1, 2}}};
  EXPECT_THROW(FindBestSetting(runs, Better::kNeither, Resamples(2)), std::logic_error);
  EXPECT_THROW(BestOfEachSeed(runs, Better::kNeither), std::logic_error);
  EXPECT_THROW(Regret({1.0}, {1.0}, Better::kNeither), std::logic_error);
}

}  // namespace
}  // namespace depthgrid
