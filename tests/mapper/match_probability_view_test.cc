#include <gtest/gtest.h>

#include "mapper/match/probability_view.h"

namespace depthgrid {
namespace {

TEST(ProbabilityView, UnknownAndOutsideAreOneConstant) {
  OccupancyMap map(
      {.resolution_m = 0.05, .min_cell = {-1, 2}, .width_cells = 2, .height_cells = 1});
  map.occupied_prob = {0.9F, kUnknownProb};
  ProbabilityView view = ViewOf(map);
  view.unknown_prob = 0.25F;
  EXPECT_EQ(view.At({-1, 2}), 0.9F);
  EXPECT_EQ(view.At({0, 2}), 0.25F);
  EXPECT_EQ(view.At({1, 2}), 0.25F);
  EXPECT_EQ(view.At({-1, 1}), 0.25F);
}

TEST(ProbabilityView, EmptyRectangleIsAllUnknown) {
  const OccupancyMap map;
  EXPECT_EQ(ViewOf(map).At({0, 0}), 0.5F);
}

}  // namespace
}  // namespace depthgrid
