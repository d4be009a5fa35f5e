#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/grid/log_odds.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/grid/probability_grid.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

Beam HitAt(float bearing_rad, float range_m) {
  return {.bearing_rad = bearing_rad,
          .range_m = range_m,
          .clear_from_m = 0.0F,
          .clear_to_m = range_m,
          .hit = true};
}

ScanCells CellsOf(const Scan& scan, const Pose2& map_from_base = {0.025, 0.025, 0.0}) {
  return CellsOfScanPlain(SegmentsOf(scan, map_from_base, 0.05));
}

TEST(LogOdds, IsTheInverseOfTheProbability) {
  for (const double p : {0.1, 0.49, 0.5, 0.55, 0.9}) {
    EXPECT_NEAR(ProbabilityFromLogOdds(LogOdds(p)), p, 1e-15);
  }
  EXPECT_EQ(LogOddsUnits(0.5), 0);
  EXPECT_EQ(LogOddsUnits(0.55), 201);  // ln(55/45) = 0.2007
  EXPECT_EQ(LogOddsUnits(0.49), -40);  // ln(49/51) = -0.0400
}

TEST(ScanCells, ABeamClearsUpToItsHit) {
  const ScanCells cells = CellsOf({{HitAt(0.0F, 0.2F)}, 6.0});
  EXPECT_EQ(cells.hit.Count(), 1U);
  EXPECT_TRUE(cells.hit.Contains({4, 0}));
  EXPECT_EQ(cells.passed.Count(), 4U);
  for (int x = 0; x < 4; ++x) EXPECT_TRUE(cells.passed.Contains({x, 0}));
}

TEST(ScanCells, OnlyTheClearIntervalIsCleared) {
  const Beam no_hit{.bearing_rad = 0.0F, .clear_from_m = 0.1F, .clear_to_m = 0.2F};
  const ScanCells cells = CellsOf({{no_hit}, 6.0});
  EXPECT_EQ(cells.hit.Count(), 0U);
  EXPECT_EQ(cells.passed.Count(), 3U);
  for (int x = 2; x <= 4; ++x) EXPECT_TRUE(cells.passed.Contains({x, 0}));
  const Beam no_data{.bearing_rad = 0.0F};
  EXPECT_EQ(CellsOf({{no_data}, 6.0}).passed.Count(), 0U);
}

TEST(ScanCells, AHitOutweighsEveryPass) {
  // The second beam goes through the cell that the first one hits.
  const ScanCells cells = CellsOf({{HitAt(-0.02F, 0.2F), HitAt(0.0F, 0.4F)}, 6.0});
  EXPECT_TRUE(cells.hit.Contains({4, 0}));
  EXPECT_FALSE(cells.passed.Contains({4, 0}));
  EXPECT_TRUE(cells.passed.Contains({5, 0}));
}

TEST(ProbabilityGrid, OneUpdateACellAndScan) {
  GridOptions options;
  ProbabilityGrid grid(options);
  Scan scan{{}, 6.0};
  for (int i = 0; i < 50; ++i)
    scan.beams.push_back(HitAt(0.001F * static_cast<float>(i - 25), 0.2F));
  grid.Insert(CellsOf(scan));
  EXPECT_NEAR(grid.map().At({4, 0}), 0.55, 1e-4);
  EXPECT_NEAR(grid.map().At({1, 0}), 0.49, 1e-4);
  EXPECT_TRUE(std::isnan(grid.map().At({5, 0})));
  grid.Insert(CellsOf(scan));
  EXPECT_NEAR(grid.map().At({4, 0}), ProbabilityFromLogOdds(2 * LogOdds(0.55)), 2e-4);
}

TEST(ProbabilityGrid, ClampsAndComesBack) {
  ProbabilityGrid grid{GridOptions{}};
  const ScanCells wall = CellsOf({{HitAt(0.0F, 0.2F)}, 6.0});
  const ScanCells farther = CellsOf({{HitAt(0.0F, 0.4F)}, 6.0});
  for (int i = 0; i < 100; ++i) grid.Insert(wall);
  EXPECT_NEAR(grid.map().At({4, 0}), 0.9, 1e-4);
  for (int i = 0; i < 55; ++i) grid.Insert(farther);
  EXPECT_NEAR(grid.map().At({4, 0}), 0.5, 3e-3);  // 2 ln 9 / 0.04 = 110 misses from 0.9 to 0.1
  for (int i = 0; i < 200; ++i) grid.Insert(farther);
  EXPECT_NEAR(grid.map().At({4, 0}), 0.1, 1e-4);
}

TEST(ProbabilityGrid, GrowingLosesNothing) {
  RandomStream random(1, RandomStage::kTest);
  const PlanarWorld world = RectangleWorld(-30.0, -30.0, 30.0, 30.0);
  const PlanarLaser laser{.beams = 60, .field_of_view_rad = 2 * kPi, .max_range_m = 8.0};
  std::vector<ScanCells> scans;
  ProbabilityGrid growing{GridOptions{}};
  for (int i = 0; i < 40; ++i) {
    const Pose2 pose{random.Uniform(-25, 25), random.Uniform(-25, 25), random.Uniform(-3, 3)};
    scans.push_back(CellsOfScanPlain(SegmentsOf(ScanOf(world, pose, laser), pose, 0.05)));
    growing.Insert(scans.back());
  }
  // The same from a grid that is large enough from the start.
  ProbabilityGrid large{GridOptions{}};
  ScanCells empty;
  empty.hit.Reset({-2000, -2000}, {2000, 2000});
  empty.passed = empty.hit;
  large.Insert(empty);
  for (const ScanCells& cells : scans) large.Insert(cells);
  int known = 0;
  for (std::size_t i = 0; i < large.map().occupied_prob.size(); ++i) {
    const float prob = large.map().occupied_prob[i];
    const float grown = growing.map().At(large.map().geometry.CellAt(i));
    ASSERT_TRUE(prob == grown || (std::isnan(prob) && std::isnan(grown)));
    known += std::isnan(prob) ? 0 : 1;
  }
  EXPECT_GT(known, 50000);
}

TEST(MapDrawing, IsAsLargeAsWhatWasSeen) {
  MapDrawing drawing{GridOptions{}};
  EXPECT_EQ(drawing.Map().geometry.size(), 0U);
  drawing.Add({{HitAt(0.0F, 0.2F)}, 6.0}, {0.025, -3.175, 0.0});
  const OccupancyMap map = drawing.Map();
  EXPECT_EQ(map.geometry.min_cell, (Cell{0, -64}));
  EXPECT_EQ(map.geometry.width_cells, 5);
  EXPECT_EQ(map.geometry.height_cells, 1);
  EXPECT_THAT(map.occupied_prob, testing::ElementsAre(0, 0, 0, 0, 1));
}

TEST(MapDrawing, CountsWeighHits) {
  GridOptions options;
  options.hit_weight = 5.0;
  MapDrawing drawing(options);
  drawing.Add({{HitAt(0.0F, 0.2F)}, 6.0}, {0.025, 0.025, 0.0});
  for (int i = 0; i < 3; ++i) drawing.Add({{HitAt(0.0F, 0.4F)}, 6.0}, {0.025, 0.025, 0.0});
  EXPECT_NEAR(drawing.Map().At({4, 0}), 5.0 / 8.0, 1e-6);
}

TEST(MapDrawing, TheLogOddsRuleIsTheGridsRule) {
  GridOptions options;
  options.raster = RasterRule::kLogOdds;
  MapDrawing drawing(options);
  ProbabilityGrid grid(options);
  const PlanarWorld world = RectangleWorld(-2.45, -2.5, 2.45, 2.5);
  for (int i = 0; i < 30; ++i) {
    const Pose2 pose{0.01 * i, 0.02 * i, 0.2 * i};
    const Scan scan = ScanOf(world, pose, {.beams = 200});
    drawing.Add(scan, pose);
    grid.Insert(CellsOfScanPlain(SegmentsOf(scan, pose, options.resolution_m)));
  }
  const OccupancyMap map = drawing.Map();
  ASSERT_GT(map.geometry.size(), 5000U);
  for (std::size_t i = 0; i < map.occupied_prob.size(); ++i) {
    const float expected = grid.map().At(map.geometry.CellAt(i));
    const float prob = map.occupied_prob[i];
    ASSERT_TRUE(prob == expected || (std::isnan(prob) && std::isnan(expected)));
  }
}

}  // namespace
}  // namespace depthgrid
