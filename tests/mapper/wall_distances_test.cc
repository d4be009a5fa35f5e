#include "mapper/grid/wall_distances.h"

#include <gtest/gtest.h>

#include "mapper/paper_reference.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

TEST(WallDistances, AreThoseOfTheCellCentresBehindTheHits) {
  // A wall at x = 1.01 m, seen from the origin: cell 20 covers [1.00, 1.05).
  const PlanarWorld wall = {{{1.01, -2.0}, {1.01, 2.0}}};
  WallDistances distances(0.05, 0.1, 0.9);
  distances.Insert(ScanOf(wall, {}, {.beams = 101, .field_of_view_rad = 0.02}), {});
  GridGeometry seen;
  seen.min_cell = {15, -2};
  seen.width_cells = seen.height_cells = 4;
  OccupancyMap map(seen);
  map.occupied_prob[0] = 0.3F;
  const OccupancyMap drawn = distances.DrawnOver(map);
  EXPECT_EQ(drawn.At({15, -2}), 0.3F);  // what no hit is near to stays
  EXPECT_TRUE(std::isnan(drawn.At({16, -2})));
  const auto bell = [](double distance_m) {
    return 0.1 + 0.8 * std::exp(-0.5 * distance_m * distance_m / (0.05 * 0.05));
  };
  EXPECT_NEAR(drawn.At({20, 0}), bell(0.015), 1e-3);
  EXPECT_NEAR(drawn.At({19, 0}), bell(-0.035), 1e-3);
  EXPECT_NEAR(drawn.At({21, 0}), bell(0.065), 1e-3);
  EXPECT_NEAR(drawn.At({18, 0}), bell(-0.085), 1e-3);
}

// Wherever the walls lie within their cells, true scans match at their true pose.
TEST(WallDistances, KeepMatchesFromTheCellsRaster) {
  double worst_m[2] = {0.0, 0.0};
  int matched = 0;
  for (int step = 0; step < 10; ++step) {
    const double shift_m = 0.005 * step;
    const PlanarWorld room =
        RectangleWorld(-2.0 + shift_m, -1.5 + shift_m, 2.0 + shift_m, 1.5 + shift_m);
    const PlanarLaser laser{.beams = 320, .field_of_view_rad = RadFromDeg(270.0)};
    for (const SubmapWalls walls : {SubmapWalls::kCounted, SubmapWalls::kAveraged}) {
      PaperReference reference({}, {.scans = 90, .walls = walls}, {}, {});
      for (int i = 0; i < 20; ++i) {
        const Pose2 pose{0.01 * i, 0.004 * i, 0.01 * i};
        reference.Insert(std::make_shared<Scan>(ScanOf(room, pose, laser)), pose, {});
      }
      const Pose2 truth{0.1, 0.04, 0.1};
      const MatchResult match = reference.Match(std::make_shared<Scan>(ScanOf(room, truth, laser)),
                                                {.map_from_base = truth});
      matched += match.found ? 1 : 0;
      double& worst = worst_m[walls == SubmapWalls::kAveraged ? 1 : 0];
      worst = std::max(worst, Between(truth, match.map_from_base).translation().norm());
    }
  }
  EXPECT_EQ(matched, 20);
  EXPECT_LT(worst_m[1], 0.01);  // a fifth of a cell
  EXPECT_LT(worst_m[1], 0.5 * worst_m[0]);
}

}  // namespace
}  // namespace depthgrid
