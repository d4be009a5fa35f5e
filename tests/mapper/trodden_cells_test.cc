#include "mapper/scan/trodden_cells.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

TEST(TroddenCells, CountsWhatWasSeenAndThenPassed) {
  TroddenCells cells;
  for (double x_m = -1.0; x_m < 1.0; x_m += 0.1) cells.See({x_m, 0.1});
  EXPECT_EQ(cells.Count(), 0U);
  cells.Pass({-0.9, 0.2});
  cells.Pass({-0.8, 0.1});  // in the same quarter of a metre
  cells.Pass({0.3, 0.1});
  cells.Pass({0.3, 0.3});  // not seen
  EXPECT_EQ(cells.Count(), 2U);
  EXPECT_TRUE(cells.IsSeen({-0.9, 0.2}));
  EXPECT_FALSE(cells.IsSeen({0.3, 0.3}));
  EXPECT_FALSE(cells.IsSeen({1e6 + 0.1, 7.0 - 1e6}));
}

TEST(TroddenCells, WhatIsSeenOnlyAfterwardsDoesNotCount) {
  TroddenCells cells;
  cells.Pass({0.1, 0.1});
  cells.See({0.1, 0.1});
  EXPECT_EQ(cells.Count(), 0U);
}

}  // namespace
}  // namespace depthgrid
