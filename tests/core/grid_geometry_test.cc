#include "mapper/core/grid_geometry.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

TEST(BoundsOf, IsTheSmallestRectangleThatContainsAll) {
  const GridGeometry bounds = BoundsOf({{3, -2}, {-4, 1}, {0, 7}}, 0.1);
  EXPECT_EQ(bounds.resolution_m, 0.1);
  EXPECT_EQ(bounds.min_cell.x, -4);
  EXPECT_EQ(bounds.min_cell.y, -2);
  EXPECT_EQ(bounds.width_cells, 8);
  EXPECT_EQ(bounds.height_cells, 10);
}

TEST(BoundsOf, OneCellIsItsOwnBounds) {
  const GridGeometry bounds = BoundsOf({{-5, 5}}, 0.05);
  EXPECT_EQ(bounds.size(), 1U);
  EXPECT_TRUE(bounds.Contains({-5, 5}));
}

TEST(BoundsOf, NoCellsHaveEmptyBoundsOfTheirResolution) {
  const GridGeometry bounds = BoundsOf({}, 0.2);
  EXPECT_EQ(bounds.size(), 0U);
  EXPECT_EQ(bounds.resolution_m, 0.2);
}

}  // namespace
}  // namespace depthgrid
