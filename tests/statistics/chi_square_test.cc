#include "eval/statistics/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval/statistics/distributions.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

TEST(ChiSquare, IsTheTablesDistribution) {
  // Two degrees: 1 - exp(-x/2). One: the square of a normal variable.
  for (const double x : {0.01, 0.5, 2.0, 7.0, 40.0}) {
    EXPECT_NEAR(ChiSquareCdf(x, 2), 1.0 - std::exp(-0.5 * x), 1e-10);
    EXPECT_NEAR(ChiSquareCdf(x, 1), 2.0 * NormalCdf(std::sqrt(x)) - 1.0, 1e-10);
  }
  EXPECT_EQ(ChiSquareCdf(0.0, 3), 0.0);
  EXPECT_EQ(ChiSquareCdf(-1.0, 3), 0.0);
  // Printed tables.
  EXPECT_NEAR(ChiSquareQuantile(0.95, 1), 3.8415, 5e-5);
  EXPECT_NEAR(ChiSquareQuantile(0.95, 3), 7.8147, 5e-5);
  EXPECT_NEAR(ChiSquareQuantile(0.025, 12), 4.4038, 5e-5);
  EXPECT_NEAR(ChiSquareQuantile(0.975, 12), 23.3367, 5e-5);
  // Wilson and Hilferty's approximation, good to 1e-4 of the value at so many degrees.
  const double h = 2.0 / (9.0 * 9000.0);
  EXPECT_NEAR(ChiSquareQuantile(0.975, 9000),
              9000.0 * std::pow(1.0 - h + 1.959964 * std::sqrt(h), 3), 0.5);
}

TEST(Consistency, WorkedByHand) {
  // Four values of three degrees: 12 in all, so the bounds are those above over 12.
  const auto c = ConsistencyOf({{1.0, 3}, {9.0, 3}, {2.0, 3}, {6.0, 3}, {5.0, 0}});
  ASSERT_TRUE(c);
  EXPECT_EQ(c->count, 4);
  EXPECT_DOUBLE_EQ(c->mean, 1.5);
  EXPECT_NEAR(c->low, 4.4038 / 12.0, 1e-5);
  EXPECT_NEAR(c->high, 23.3367 / 12.0, 1e-5);
  EXPECT_DOUBLE_EQ(c->share_within_95, 0.75);  // 9 is above 7.81
  EXPECT_FALSE(ConsistencyOf({{5.0, 0}}));
}

TEST(Consistency, RightCovariancesLieWithinTheBandAndDoubledOnesDoNot) {
  RandomStream random(3, RandomStage::kTest);
  std::vector<ChiSquareSample> right, doubled;
  for (int i = 0; i < 2000; ++i) {
    double value = 0.0;
    for (int axis = 0; axis < 3; ++axis) value += std::pow(random.Normal(), 2);
    right.push_back({value, 3});
    doubled.push_back({0.5 * value, 3});
  }
  const auto r = ConsistencyOf(right);
  EXPECT_GT(r->mean, r->low);
  EXPECT_LT(r->mean, r->high);
  EXPECT_NEAR(r->share_within_95, 0.95, 0.015);
  EXPECT_LT(ConsistencyOf(doubled)->mean, r->low);
}

}  // namespace
}  // namespace depthgrid
