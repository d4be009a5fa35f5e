#include "mapper/grid/wall_distances.h"

#include <gtest/gtest.h>

#include "mapper/grid/wall_normals.h"
#include "mapper/paper_reference.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

// A parabola that is free 1.75 cells of 5 cm from the wall.
double ProbAt(double distance_m) {
  return 0.1 + 0.8 * std::max(0.0, 1.0 - distance_m * distance_m / (0.0875 * 0.0875));
}

TEST(WallDistances, AreThoseOfTheCellCentresBehindTheHits) {
  // A wall at x = 1.01 m, seen from the origin: cell 20 covers [1.00, 1.05).
  const PlanarWorld wall = {{{1.01, -2.0}, {1.01, 2.0}}};
  WallDistances distances(0.05, 0.1, 0.9);
  WallMemory memory;
  distances.Insert(FindWallDistances(ScanOf(wall, {}, {.beams = 101, .field_of_view_rad = 0.02}),
                                     {}, 0.05, memory));
  GridGeometry seen;
  seen.min_cell = {15, -2};
  seen.width_cells = seen.height_cells = 4;
  OccupancyMap map(seen);
  map.occupied_prob[0] = 0.3F;
  OccupancyMap drawn;
  distances.DrawOver(map, drawn);
  EXPECT_EQ(drawn.At({15, -2}), 0.3F);  // what no hit is near to stays
  EXPECT_TRUE(std::isnan(drawn.At({16, -2})));
  constexpr double kTenthMm = 2e-3;  // where the parabola is steepest
  EXPECT_NEAR(drawn.At({20, 0}), ProbAt(0.015), kTenthMm);
  EXPECT_NEAR(drawn.At({19, 0}), ProbAt(-0.035), kTenthMm);
  EXPECT_NEAR(drawn.At({21, 0}), ProbAt(0.065), kTenthMm);
  EXPECT_NEAR(drawn.At({18, 0}), ProbAt(-0.085), kTenthMm);
  EXPECT_NEAR(drawn.At({22, 0}), 0.1, 1e-6);  // 0.115 m behind the wall
}

TEST(WallDistances, AreAcrossTheWallHoweverItIsSeen) {
  // A wall at 45 degrees through (1, 0): the distance of (x, y) behind it is (x + y - 1) / sqrt 2.
  const PlanarWorld wall = {{{3.0, -2.0}, {-1.0, 2.0}}};
  const Scan scan = ScanOf(wall, {}, {.beams = 200, .field_of_view_rad = RadFromDeg(40.0)});
  std::vector<WallHit> hits;
  FindWallHits(scan, 0.1, hits);
  ASSERT_EQ(hits.size(), 200U);
  for (const WallHit& hit : hits) {
    EXPECT_NEAR(hit.normal.x(), std::sqrt(0.5), 1e-5);
    EXPECT_NEAR(hit.normal.y(), std::sqrt(0.5), 1e-5);
  }
  WallDistances distances(0.05, 0.1, 0.9);
  WallMemory memory;
  distances.Insert(FindWallDistances(scan, {}, 0.05, memory));
  OccupancyMap drawn;
  distances.DrawOver({}, drawn);
  for (const Cell cell : {Cell{19, 0}, Cell{20, -1}, Cell{17, 2}, Cell{22, -2}}) {
    const Eigen::Vector2d centre = CellCentre(cell, 0.05);
    const double behind_m = (centre.x() + centre.y() - 1.0) * std::sqrt(0.5);
    EXPECT_NEAR(drawn.At(cell), ProbAt(behind_m), 1e-3);
  }
}

TEST(WallHits, WithoutNeighboursFaceTheSensor) {
  Scan scan;
  scan.beams = {{.bearing_rad = -0.3F, .range_m = 2.0F, .hit = true},
                {.bearing_rad = 0.3F, .range_m = 4.0F, .hit = true},
                {.bearing_rad = 0.4F, .range_m = 4.0F}};
  std::vector<WallHit> hits;
  FindWallHits(scan, 0.1, hits);
  ASSERT_EQ(hits.size(), 2U);
  EXPECT_NEAR((hits[0].normal - Eigen::Vector2d(std::cos(-0.3), std::sin(-0.3))).norm(), 0.0, 1e-6);
  EXPECT_NEAR((hits[1].point - 4.0 * hits[1].normal).norm(), 0.0, 1e-6);
  FindWallHits({}, 0.1, hits);
  EXPECT_TRUE(hits.empty());
}

// Each scan ends on a stretch of wall that the map does not have yet; its cells at the end are hit
// on one side only. The turn must not be pulled along.
TEST(WallDistances, DoNotTurnAViewThatMovesAlongAWall) {
  const PlanarWorld wall = {{{2.0, -20.0}, {2.0, 20.0}}};
  PaperReference reference({}, {.walls = SubmapWalls::kAveraged}, {}, {});
  constexpr int kScans = 30;
  double pulled_rad = 0.0;
  for (int i = 0; i <= kScans; ++i) {
    const Pose2 truth{0.0, 0.0, 0.01 * i};
    const auto scan = std::make_shared<Scan>(
        ScanOf(wall, truth, {.beams = 640, .field_of_view_rad = RadFromDeg(58.0)}));
    if (i > 0) {
      const MatchResult match = reference.Match(scan, {.map_from_base = truth});
      pulled_rad += Between(truth, match.map_from_base).yaw_rad;
    }
    reference.Insert(scan, truth, {});
  }
  EXPECT_LT(std::abs(pulled_rad / kScans), 2e-4);
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
  EXPECT_LT(worst_m[1], 0.0025);  // a twentieth of a cell
  EXPECT_LT(worst_m[1], 0.1 * worst_m[0]);
}

}  // namespace
}  // namespace depthgrid
