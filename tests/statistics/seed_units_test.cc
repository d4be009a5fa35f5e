// What varies on its own among runs of one or several seeds.
#include "eval/statistics/seed_units.h"

#include <gmock/gmock.h>

#include <cmath>

#include "eval/statistics/wilcoxon.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Seeds = std::vector<std::vector<std::string>>;

TEST(SeedUnits, RunsOfOneSeedAreAveraged) {
  const SeedUnits units(Seeds{{"1"}, {"2"}, {"1"}, {"2"}});
  EXPECT_EQ(units.count(), 2U);
  EXPECT_THAT(units.crossed(), IsEmpty());
  EXPECT_THAT(units.Figures({1, 10, 3, NAN}), ElementsAre(2, 10));
  EXPECT_TRUE(std::isnan(units.Figures({1, NAN, 3, NAN})[1]));
}

TEST(SeedUnits, WithoutSeedsThatVaryEachRunIsOne) {
  EXPECT_THAT(SeedUnits(Seeds{{}, {}, {}}).Figures({3, 1, 2}), ElementsAre(3, 1, 2));
  EXPECT_THAT(SeedUnits(Seeds{{"7"}, {"7"}, {"7"}}).Figures({3, 1, 2}), ElementsAre(3, 1, 2));
  EXPECT_EQ(SeedUnits(Seeds{}).count(), 0U);
}

// Seeds that change together are one axis; of runs with seeds of their own within another seed that
// one counts.
TEST(SeedUnits, AxesThatDecideEachOtherAreNotCrossed) {
  const SeedUnits together(Seeds{{"1", "5", "0"}, {"2", "6", "0"}, {"3", "7", "0"}});
  EXPECT_THAT(together.Figures({1, 2, 4}), ElementsAre(1, 2, 4));
  EXPECT_THAT(together.crossed(), IsEmpty());
  const SeedUnits nested(Seeds{{"11", "1"}, {"12", "1"}, {"21", "2"}, {"22", "2"}});
  EXPECT_THAT(nested.Figures({1, 3, 10, 20}), ElementsAre(2, 15));
  EXPECT_THAT(nested.crossed(), IsEmpty());
}

// Rows 1 and 2, columns 1 and 2 of [[1, 2], [4, 9]], whose mean is 4: 1.5 + 2.5 - 4, 6.5 + 5.5 - 4.
TEST(SeedUnits, OfCrossedSeedsThereAreAsManyAsOfOne) {
  const SeedUnits units(Seeds{{"1", "1"}, {"1", "2"}, {"2", "1"}, {"2", "2"}});
  EXPECT_EQ(units.count(), 2U);
  EXPECT_THAT(units.crossed(), ElementsAre(0, 1));
  EXPECT_THAT(units.Figures({1, 2, 4, 9}), ElementsAre(0, 8));
}

// Rows 0.1 / 3, columns 0, 0.1, 0, all 0.3 / 9: what 0.1 / 3 - 0.3 / 9 leaves is rounding.
TEST(SeedUnits, MeansThatCancelLeaveNoRounding) {
  Seeds seeds;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) seeds.push_back({std::to_string(i), std::to_string(k)});
  }
  const auto figures = SeedUnits(seeds).Figures({0, 0.1, 0, 0, 0.1, 0, 0, 0.1, 0});
  EXPECT_EQ(figures[0], 0.0);
  EXPECT_NEAR(figures[1], 0.1, 1e-15);
  EXPECT_EQ(figures[2], 0.0);
}

// Two seeds with four: the four go to the two in pairs.
TEST(SeedUnits, TheLongerAxisIsSharedOut) {
  Seeds seeds;
  std::vector<double> values;
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 4; ++k) {
      seeds.push_back({std::to_string(k), std::to_string(i)});
      values.push_back(10.0 * i + k);
    }
  }
  // Rows 1.5 and 11.5, columns 5.5 and 7.5, all 6.5.
  EXPECT_THAT(SeedUnits(seeds).Figures(values), ElementsAre(0.5, 12.5));
}

// Three seeds with two: of the three two go to the first. Their mean is that of all runs all the
// same, as others compute it.
TEST(SeedUnits, HaveTheMeanOfAllRuns) {
  Seeds seeds;
  std::vector<double> values;
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) {
      seeds.push_back({std::to_string(k), std::to_string(i)});
      values.push_back(100.0 * i + 10.0 * k * k);
    }
  }
  const std::vector<double> figures = SeedUnits(seeds).Figures(values);
  // Rows 16.7 and 116.7, columns 5 and 40, all 66.7: the spread is that of both.
  EXPECT_NEAR(figures[0] + figures[1], 2.0 * 400.0 / 6.0, 1e-9);
  EXPECT_NEAR(figures[1] - figures[0], 135.0, 1e-9);
}

// Where there is no difference a test at 5 % finds one in about 5 % of all cases, whichever seed
// the errors hang on. Each run counted alone would be 50 %, the means of one axis up to 50 %.
TEST(SeedUnits, OfCrossedSeedsKeepTheLevelOfATest) {
  constexpr int kSeeds = 10;
  constexpr int kTrials = 1000;
  struct Spread {
    double first, second, run;
  };
  for (const Spread& spread : {Spread{1, 1, 1}, Spread{0, 1, 1}, Spread{1, 0, 0.1}}) {
    int found = 0;
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
      RandomStream random(1, RandomStage::kTest, trial);
      std::vector<double> first(kSeeds), second(kSeeds), values;
      for (double& error : first) error = spread.first * random.Normal();
      for (double& error : second) error = spread.second * random.Normal();
      Seeds seeds;
      for (int i = 0; i < kSeeds; ++i) {
        for (int k = 0; k < kSeeds; ++k) {
          seeds.push_back({std::to_string(i), std::to_string(k)});
          values.push_back(first[static_cast<std::size_t>(i)] +
                           second[static_cast<std::size_t>(k)] + spread.run * random.Normal());
        }
      }
      found += Wilcoxon(SeedUnits(seeds).Figures(values)).p_value < 0.05 ? 1 : 0;
    }
    EXPECT_LT(found, 70) << spread.first << " " << spread.second;  // 50 and three sigma
  }
}

}  // namespace
}  // namespace depthgrid
