#include "mapper/core/rng.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depthgrid {
namespace {

TEST(RandomWords, AreThePublishedPhilox) {
  // Random123's kat_vectors, philox4x32 10 rounds, counter and key zero. Our counter carries the
  // stage, so it is zero only for the (unused) stage 0.
  const auto words = RandomWords(0, static_cast<RandomStage>(0), 0, 0);
  EXPECT_EQ(words, (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
}

TEST(RandomWords, EveryPartOfTheKeyMatters) {
  const auto base = RandomWords(1, RandomStage::kTest, 2, 3);
  EXPECT_NE(base, RandomWords(1ULL | (1ULL << 32), RandomStage::kTest, 2, 3));
  EXPECT_NE(base, RandomWords(1, RandomStage::kSweep, 2, 3));
  EXPECT_NE(base, RandomWords(1, RandomStage::kTest, 3, 3));
  EXPECT_NE(base, RandomWords(1, RandomStage::kTest, 2, 4));
  EXPECT_EQ(base, RandomWords(1, RandomStage::kTest, 2, 3));
}

TEST(RandomStream, NormalsHaveTheDeclaredMoments) {
  constexpr int kDraws = 200000;
  RandomStream random(7, RandomStage::kTest);
  double sum = 0.0;
  double sum2 = 0.0;
  double sum4 = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Normal();
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
  }
  // Four standard errors of each moment: 1, sqrt(2), sqrt(96) over sqrt(n).
  const double root_n = std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(sum / kDraws, 0.0, 4.0 / root_n);
  EXPECT_NEAR(sum2 / kDraws, 1.0, 4.0 * std::sqrt(2.0) / root_n);
  EXPECT_NEAR(sum4 / kDraws, 3.0, 4.0 * std::sqrt(96.0) / root_n);
}

TEST(RandomStream, UniformIsInsideTheOpenInterval) {
  RandomStream random(8, RandomStage::kTest);
  for (int i = 0; i < 100000; ++i) {
    const double x = random.Uniform();
    ASSERT_GT(x, 0.0);
    ASSERT_LT(x, 1.0);
  }
}

TEST(RandomStream, BelowIsUniform) {
  RandomStream random(9, RandomStage::kTest);
  std::array<int, 7> counts{};
  constexpr int kDraws = 70000;
  for (int i = 0; i < kDraws; ++i) ++counts[random.Below(7)];
  double chi2 = 0.0;
  for (const int count : counts) chi2 += (count - 1e4) * (count - 1e4) / 1e4;
  EXPECT_LT(chi2, 22.5);  // 99.9 % of chi-squared with 6 degrees of freedom
}

}  // namespace
}  // namespace depthgrid
