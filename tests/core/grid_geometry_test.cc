#include "mapper/core/grid_geometry.h"

#include <gtest/gtest.h>

#include <limits>

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

TEST(Union, OfGridsTooFarApartIsTooLargeAndNothingOverflows) {
  const GridGeometry here{0.005, {0, 0}, 10, 10};
  const GridGeometry there{0.005, {2'000'000'000, -5}, 10, 10};
  const GridGeometry opposite{0.005, {-2'000'000'000, 0}, 10, 10};
  EXPECT_EQ(Union(here, there).width_cells, 2'000'000'010);
  EXPECT_EQ(Union(here, there).height_cells, 15);
  EXPECT_EQ(Union(there, opposite).width_cells, std::numeric_limits<int>::max());
}

}  // namespace
}  // namespace depthgrid
