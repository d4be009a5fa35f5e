#include "eval/statistics/wilcoxon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "eval/statistics/holm.h"
#include "mapper/core/rng.h"
#include "tests/statistics/ten_runs.h"

namespace depthgrid {
namespace {

// Expected values are SciPy 1.10.1's (Debian's python3-scipy):
//   from scipy.stats import wilcoxon, rankdata
//   d = (np.array([.312,.340,.301,.305,.344,.290,.377,.401,.262,.350])
//     - np.array([.407,.361,.455,.298,.512,.333,.420,.389,.275,.468]))
//   wilcoxon(d, mode='exact'), wilcoxon(d, mode='approx')

std::vector<double> Differences() {
  std::vector<double> differences;
  for (std::size_t i = 0; i < kA.size(); ++i) differences.push_back(kB[i] - kA[i]);
  return differences;
}

// W+, whose double is whole.
double PositiveRanks(const WilcoxonResult& result) {
  const double total = 0.5 * result.pairs * (result.pairs + 1);
  return 0.5 * std::round((1.0 + result.rank_biserial) * total);
}

TEST(Wilcoxon, SmallSampleIsExact) {
  const WilcoxonResult result = Wilcoxon(Differences());
  EXPECT_EQ(result.pairs, 10);
  EXPECT_EQ(result.statistic, 3.0);
  EXPECT_EQ(PositiveRanks(result), 3.0);
  EXPECT_TRUE(result.exact);
  EXPECT_NEAR(result.p_value, 0.009765625, 1e-15);
  EXPECT_NEAR(result.rank_biserial, (3.0 - 52.0) / 55.0, 1e-15);
}

TEST(Wilcoxon, NormalApproximation) {
  const WilcoxonResult result = Wilcoxon(Differences(), WilcoxonMethod::kNormal);
  EXPECT_FALSE(result.exact);
  EXPECT_NEAR(result.p_value, 0.012515318690073973, 1e-12);
}

// y = np.sin(r * 12.9898) * np.sqrt(r) + 1, r = np.arange(1, n + 1); wilcoxon(y)
std::vector<double> Wavy(int n) {
  std::vector<double> values;
  for (int r = 1; r <= n; ++r) values.push_back(std::sin(r * 12.9898) * std::sqrt(r) + 1.0);
  return values;
}

TEST(Wilcoxon, ChoosesTheMethodAsSciPyDoes) {
  const WilcoxonResult forty = Wilcoxon(Wavy(40));
  EXPECT_TRUE(forty.exact);
  EXPECT_EQ(forty.statistic, 265.0);
  EXPECT_NEAR(forty.p_value, 0.051399685278738616, 1e-12);
  const WilcoxonResult sixty = Wilcoxon(Wavy(60));
  EXPECT_FALSE(sixty.exact);
  EXPECT_EQ(sixty.statistic, 721.0);
  EXPECT_NEAR(sixty.p_value, 0.1532484058834784, 1e-12);
}

// Where the sum of all ranks is more than an int holds.
TEST(Wilcoxon, OfManyPairs) {
  std::vector<double> differences;
  for (int i = 1; i <= 50000; ++i) differences.push_back(i % 4 == 0 ? -i : i);
  const WilcoxonResult result = Wilcoxon(differences);
  EXPECT_NEAR(result.rank_biserial, 0.5, 1e-3);
  EXPECT_EQ(result.p_value, 0.0);
}

// The normal figure is wilcoxon(x, mode='approx'); SciPy has no exact one, so:
//   x = x[x != 0]; r = rankdata(abs(x)); T = (r * (x > 0)).sum(); n = len(x)
//   W = ((np.arange(2**n)[:, None] >> np.arange(n)) & 1) @ r
//   2 * min((W <= T).mean(), (W >= T).mean())
TEST(Wilcoxon, TiesAndZeros) {
  const std::vector<double> x = {1, -1, 2, 2, -3, 4, 0, 0, 5, 5, -2, 7, 8, 1};
  const WilcoxonResult normal = Wilcoxon(x, WilcoxonMethod::kNormal);
  EXPECT_EQ(normal.pairs, 12);
  EXPECT_EQ(normal.zeros, 2);
  EXPECT_EQ(normal.statistic, 14.0);
  EXPECT_NEAR(normal.p_value, 0.04906971299221849, 1e-12);
  const WilcoxonResult exact = Wilcoxon(x, WilcoxonMethod::kExact);
  EXPECT_EQ(PositiveRanks(exact), 64.0);
  EXPECT_NEAR(exact.p_value, 0.0517578125, 1e-15);
}

TEST(Wilcoxon, NothingToRank) {
  const WilcoxonResult result = Wilcoxon({0.0, 0.0, 0.0});
  EXPECT_EQ(result.pairs, 0);
  EXPECT_EQ(result.zeros, 3);
  EXPECT_EQ(result.p_value, 1.0);
  EXPECT_EQ(result.rank_biserial, 0.0);
  EXPECT_EQ(Wilcoxon({}).p_value, 1.0);
  EXPECT_EQ(Wilcoxon({-0.5}).p_value, 1.0);  // one pair can never decide
}

// Sizes a third of the rounding apart: a group of ties ends one rounding above its smallest size,
// though each size is tied with its neighbours. Ranks 2.5 of the first four, then 5.5.
TEST(Wilcoxon, ATieReachesNoFurtherThanRounding) {
  PairedDifferences differences;
  for (int i = 0; i < 6; ++i) {
    differences.values.push_back((i % 2 == 0 ? 1.0 : -1.0) * (1.0 + i * 1.0e-9));
    differences.rounding.push_back(3.5e-9);
  }
  EXPECT_EQ(PositiveRanks(WilcoxonOfPairs(differences)), 2.5 + 2.5 + 5.5);
  EXPECT_EQ(PositiveRanks(Wilcoxon(differences.values)), 1.0 + 3.0 + 5.0);
}

TEST(PairedDifferences, OfEqualScoresAreZeroWhateverRoundingLeft) {
  // The same distance between two cells, and one that went astray beside two that did not.
  const PairedDifferences d =
      DifferencesOf({0.07071067811865465, 1e9, 0.1}, {0.07071067811865463, 1e9 + 1.0, 0.1000001});
  EXPECT_EQ(d.values[0], 0.0);
  EXPECT_EQ(d.values[1], 0.0);
  EXPECT_NEAR(d.values[2], 1e-7, 1e-15);
  EXPECT_NEAR(d.rounding[1], 1.0, 1e-6);
  EXPECT_NEAR(d.rounding[2], 1e-10, 1e-15);
}

TEST(Wilcoxon, ExactAgreesWithAllSigns) {
  RandomStream random(3, RandomStage::kTest);
  int compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto n = 2 + random.Below(8);
    std::vector<double> sizes;
    // Few distinct sizes: many ties.
    for (std::uint64_t i = 0; i < n; ++i)
      sizes.push_back(1.0 + static_cast<double>(random.Below(5)));
    const auto signed_by = [&](unsigned pattern) {
      std::vector<double> d = sizes;
      for (std::size_t i = 0; i < d.size(); ++i) d[i] *= (pattern >> i) & 1U ? 1.0 : -1.0;
      return d;
    };
    std::vector<double> all;
    for (unsigned p = 0; p < 1U << n; ++p) all.push_back(PositiveRanks(Wilcoxon(signed_by(p))));
    const auto pattern = static_cast<unsigned>(random.Below(1ULL << n));
    const WilcoxonResult result = Wilcoxon(signed_by(pattern));
    const auto at_most =
        std::count_if(all.begin(), all.end(), [&](double w) { return w <= result.statistic; });
    const double p_value =
        std::min(1.0, 2.0 * static_cast<double>(at_most) / static_cast<double>(all.size()));
    EXPECT_NEAR(result.p_value, p_value, 1e-12);
    ++compared;
  }
  EXPECT_EQ(compared, 60);
}

TEST(Wilcoxon, FindsWhatIsNotThereAsOftenAsItSays) {
  RandomStream random(4, RandomStage::kTest);
  constexpr int kTrials = 4000;
  int found = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> d;
    for (int i = 0; i < 12; ++i) d.push_back(random.Normal());
    found += Wilcoxon(d).p_value < 0.05 ? 1 : 0;
  }
  // For 12 pairs the largest attainable level up to 5 % is 4.2 %; 3 standard errors are 1 %.
  EXPECT_NEAR(found / static_cast<double>(kTrials), 0.0425, 0.01);
}

// R's p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm") by hand: sorted .005*4, .01*3, .03*2, .04*1 made
// monotone.
TEST(Holm, HandWorked) {
  const auto adjusted = HolmAdjusted({0.01, 0.04, 0.03, 0.005});
  const std::vector<double> expected = {0.03, 0.06, 0.06, 0.02};
  ASSERT_EQ(adjusted.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-15);
  EXPECT_EQ(HolmAdjusted({0.6, 0.7}), (std::vector<double>{1.0, 1.0}));
  EXPECT_TRUE(HolmAdjusted({}).empty());
}

}  // namespace
}  // namespace depthgrid
