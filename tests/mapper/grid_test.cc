#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/error.h"
#include "mapper/grid/log_odds.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/grid/probability_grid.h"
#include "mapper/grid/scan_rasterizer.h"
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
  return CellsOfScanPlain(SegmentBuilder().Build(scan, map_from_base, 0.05));
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

// Rooms full of clutter, seen with every kind of laser, range and gap in the data.
TEST(ScanRasterizer, GivesTheCellsOfThePlainReference) {
  RandomStream random(2, RandomStage::kTest);
  ScanRasterizer rasterizer;
  SegmentBuilder builder;
  int cases = 0;
  std::size_t passed = 0;
  for (const double field_of_view_deg : {0.5, 58.0, 140.0, 359.0}) {
    for (const int beams : {1, 2, 45, 640}) {
      for (int i = 0; i < 60; ++i, ++cases) {
        PlanarWorld world = RectangleWorld(-6.0, -7.0, 9.0, 5.0);
        for (int wall = 0; wall < 8; ++wall) {
          const Eigen::Vector2d from(random.Uniform(-6, 9), random.Uniform(-7, 5));
          world.push_back({from, from + Eigen::Vector2d(random.Normal(), random.Normal())});
        }
        const Pose2 pose{random.Uniform(-3, 3), random.Uniform(-3, 3), random.Uniform(-4, 4)};
        Scan scan = ScanOf(world, pose,
                           {.beams = beams,
                            .field_of_view_rad = RadFromDeg(field_of_view_deg),
                            .min_range_m = i % 3 == 0 ? 0.0 : 0.4,
                            .max_range_m = i % 2 == 0 ? 6.0 : 20.0,
                            .sigma_of_range = i % 4 == 0 ? 0.0 : 0.01},
                           static_cast<std::uint64_t>(i));
        for (Beam& beam : scan.beams) {
          if (random.Uniform() < 0.05) beam = {.bearing_rad = beam.bearing_rad};
          if (random.Uniform() < 0.1) beam.clear_from_m = beam.clear_to_m * 0.7F;
        }
        const double margin_m = i % 5 == 0 ? 0.07 : 0.0;
        const ScanCells plain = CellsOfScanPlain(builder.Build(scan, pose, 0.05, margin_m));
        const ScanCells& fast = rasterizer.Rasterize(scan, pose, 0.05, margin_m);
        ASSERT_EQ(fast.hit, plain.hit);
        ASSERT_EQ(fast.passed, plain.passed)
            << field_of_view_deg << " deg, " << beams << " beams, case " << i;
        passed += plain.passed.Count();
      }
    }
  }
  EXPECT_EQ(cases, 960);
  EXPECT_GT(passed, 1000000U);
}

// Beams along the axes and the diagonals from a cell's corner and centre meet corners exactly.
TEST(ScanRasterizer, GivesTheCellsOfThePlainReferenceOnGridLines) {
  ScanRasterizer rasterizer;
  SegmentBuilder builder;
  for (const double x : {0.0, 0.5, 0.25}) {
    for (const double y : {0.0, 0.5}) {
      for (int turn = 0; turn < 8; ++turn) {
        Scan scan{{}, 20.0};
        for (int i = -4; i <= 3; ++i) {
          scan.beams.push_back(HitAt(static_cast<float>(i * kPi / 4), 7.0F));
        }
        const Pose2 pose{x, y, turn * kPi / 4};
        const ScanCells plain = CellsOfScanPlain(builder.Build(scan, pose, 1.0));
        const ScanCells& fast = rasterizer.Rasterize(scan, pose, 1.0);
        ASSERT_EQ(fast.hit, plain.hit);
        ASSERT_EQ(fast.passed, plain.passed) << x << " " << y << " " << turn;
      }
    }
  }
}

// A beam along a boundary of rows but for less than a double's slope can tell.
TEST(ScanRasterizer, GivesTheCellsOfThePlainReferenceAlongABoundary) {
  SegmentBuilder builder;
  for (const double yaw_rad : {1e-310, -1e-310, 0.0}) {
    const Pose2 pose{0.5, 0.0, yaw_rad};
    const Scan scan{{HitAt(-0.4F, 5.0F), HitAt(0.0F, 4.0F), HitAt(0.4F, 5.0F)}, 20.0};
    const ScanCells plain = CellsOfScanPlain(builder.Build(scan, pose, 1.0));
    ScanRasterizer rasterizer;
    const ScanCells& fast = rasterizer.Rasterize(scan, pose, 1.0);
    EXPECT_EQ(fast.hit, plain.hit);
    EXPECT_EQ(fast.passed, plain.passed) << yaw_rad;
  }
}

TEST(ScanRasterizer, UnsortedBeamsAreStillRight) {
  const Scan scan{{HitAt(0.3F, 2.0F), HitAt(-0.2F, 3.0F), HitAt(0.1F, 1.0F)}, 6.0};
  ScanRasterizer rasterizer;
  EXPECT_EQ(rasterizer.Rasterize(scan, {0.025, 0.025, 0.0}, 0.05).passed, CellsOf(scan).passed);
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
    scans.push_back(CellsOf(ScanOf(world, pose, laser), pose));
    growing.Insert(scans.back());
  }
  // The same from a grid that is large enough from the start.
  ProbabilityGrid large{GridOptions{}};
  ScanCells empty;
  empty.hit.Reset({-800, -800}, {800, 800});
  empty.passed = empty.hit;
  large.Insert(empty);
  for (const ScanCells& cells : scans) large.Insert(cells);
  int known = 0;
  const OccupancyMap& expected = large.map();
  const OccupancyMap& map = growing.map();
  for (std::size_t i = 0; i < expected.occupied_prob.size(); ++i) {
    const float prob = expected.occupied_prob[i];
    const float grown = map.At(expected.geometry.CellAt(i));
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

TEST(MapDrawing, AMapOfAbsurdSizeIsRefusedBeforeItIsMade) {
  MapDrawing drawing{GridOptions{}};
  const Scan scan{{HitAt(0.0F, 0.2F)}, 6.0};
  drawing.Add(scan, {0.0, 0.0, 0.0});
  try {
    drawing.Add(scan, {8000.0, 14000.0, 0.0});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("map: spans 800"));
    EXPECT_THAT(error.what(), testing::HasSubstr(" x 1400"));
  }
  EXPECT_THROW(drawing.Map(), InputError);
}

// Its cells would take 7 GB before anything was said.
TEST(MapDrawing, ASingleScanMayBeTooLarge) {
  Scan fan;
  for (int i = 0; i <= 90; ++i) {
    fan.beams.push_back({static_cast<float>(RadFromDeg(i)), 0.0F, 0.0F, 900.0F, false});
  }
  EXPECT_THROW(MapDrawing{GridOptions{}}.Add(fan, {}), InputError);
}

TEST(MapDrawing, CountsWeighHits) {
  GridOptions options;
  options.hit_weight = 5.0;
  MapDrawing drawing(options);
  drawing.Add({{HitAt(0.0F, 0.2F)}, 6.0}, {0.025, 0.025, 0.0});
  for (int i = 0; i < 3; ++i) drawing.Add({{HitAt(0.0F, 0.4F)}, 6.0}, {0.025, 0.025, 0.0});
  EXPECT_NEAR(drawing.Map().At({4, 0}), 5.0 / 8.0, 1e-6);
}

// A wall 5 m away, seen with a sigma of 1 % a hundred times: its hits spread over five cells.
TEST(MapDrawing, NoisyWallsAreAsThickAsTheirSurface) {
  const PlanarWorld wall = {{{5.025, -3.0}, {5.025, 3.0}}};  // the middle of column 100
  const auto column_counts = [&](double min_surface_share) {
    GridOptions options;
    options.min_surface_share = min_surface_share;
    MapDrawing drawing(options);
    for (std::uint32_t i = 0; i < 100; ++i) {
      drawing.Add(ScanOf(wall, {}, {.sigma_of_range = 0.01}, 3, i), {});
    }
    const StateMap states = StatesOf(drawing.Map());
    int occupied = 0, far = 0, found = 0, free_behind = 0;
    for (int y = -40; y < 40; ++y) {
      bool found_here = false;
      for (int x = 90; x <= 115; ++x) {
        const CellState state = states.At({x, y});
        free_behind += state == CellState::kFree && x > 103 ? 1 : 0;
        if (state != CellState::kOccupied) continue;
        ++occupied;
        far += std::abs(x - 100) > 1 ? 1 : 0;
        found_here = found_here || std::abs(x - 100) <= 1;
      }
      found += found_here ? 1 : 0;
    }
    EXPECT_EQ(found, 80);
    EXPECT_LE(free_behind, 4);
    return std::pair(occupied, far);
  };
  EXPECT_GT(column_counts(0.0).second, 120);
  const auto [occupied, far] = column_counts(0.35);
  EXPECT_LE(occupied, 240);
  EXPECT_LE(far, 8);
}

// Ten scans see a wall in one cell. One ended in the cell before it, which the ten passed, and one
// in the cell behind it, which then three passed: before a wall more passes than hits make a free
// cell, behind it many more are needed.
TEST(MapDrawing, BesideAWallACellInFrontIsFreeSoonerThanOneBehind) {
  MapDrawing drawing{GridOptions{}};
  const auto add = [&](float range_m, int scans) {
    const float step_rad = 0.05F / range_m;
    for (int i = 0; i < scans; ++i) {
      drawing.Add({{HitAt(0.0F, range_m), HitAt(step_rad, range_m)}, 6.0}, {0.025, 0.025, 0.0});
    }
  };
  add(1.0F, 10);
  add(0.95F, 1);
  add(1.05F, 1);
  add(1.2F, 3);
  const OccupancyMap map = drawing.Map();
  EXPECT_EQ(map.At({20, 0}), 5.0F * 10 / (5.0F * 10 + 4));
  EXPECT_EQ(map.At({19, 0}), 0.0F);
  EXPECT_TRUE(std::isnan(map.At({21, 0})));
}

// A far scan that is off counts less than a near one: its range is not known as well.
TEST(MapDrawing, ASurfaceIsWhereNearScansSawIt) {
  MapDrawing drawing{GridOptions{}};
  const auto add = [&](float range_m, double from_x_m, int scans) {
    const float step_rad = 0.05F / range_m;
    for (int i = 0; i < scans; ++i) {
      drawing.Add({{HitAt(0.0F, range_m), HitAt(step_rad, range_m)}, 6.0}, {from_x_m, 0.025, 0.0});
    }
  };
  add(1.0F, 4.025, 4);  // cell 100
  add(5.1F, 0.025, 6);  // cell 102, from five times as far
  const OccupancyMap map = drawing.Map();
  EXPECT_GT(map.At({100, 0}), 0.65F);
  EXPECT_FALSE(map.At({102, 0}) > 0.65F);
}

TEST(MapDrawing, TheLogOddsRuleIsTheGridsRule) {
  GridOptions options;
  options.raster = RasterRule::kLogOdds;
  options.min_surface_share = 0.0;
  MapDrawing drawing(options);
  ProbabilityGrid grid(options);
  const PlanarWorld world = RectangleWorld(-2.45, -2.5, 2.45, 2.5);
  for (int i = 0; i < 30; ++i) {
    const Pose2 pose{0.01 * i, 0.02 * i, 0.2 * i};
    const Scan scan = ScanOf(world, pose, {.beams = 200});
    drawing.Add(scan, pose);
    grid.Insert(CellsOf(scan, pose));
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
