#include "mapper/graph/known_place.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mapper/core/rng.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

const PlanarLaser kNarrowLaser{
    .beams = 160, .field_of_view_rad = RadFromDeg(58.0), .sigma_of_range = 0.01};

std::vector<MappedFrame> StraightOn(int count) {
  const PlanarWorld room = FurnishedRoom();
  std::vector<MappedFrame> frames;
  for (int i = 0; i < count; ++i) {
    const Pose2 pose{1.0 + 0.02 * i, 1.0, 0.3};
    frames.push_back(MappedFrameAt(room, kNarrowLaser, pose, pose, i));
  }
  return frames;
}

// A laser that sees 600 m would have grids of 24,000 cells a side.
TEST(Place, EndsWhereNothingTellsItFromOthersAnyMore) {
  Scan scan;
  scan.max_range_m = 600.0;
  scan.beams = {{.bearing_rad = 0.0F, .range_m = 590.0F, .clear_to_m = 590.0F, .hit = true},
                {.bearing_rad = 0.1F, .range_m = 30.0F, .clear_to_m = 30.0F, .hit = true},
                {.bearing_rad = 0.2F, .clear_to_m = 600.0F}};
  MappedFrame frame;
  frame.scan = ScanArchive().Keep(scan);
  const std::vector<MappedFrame> frames = {frame};
  EXPECT_EQ(PointsOfPlace(frames, {0}, 0, 0.05).size(), 1U);
  const GridGeometry grid = DrawPlace(frames, {0}, 0, 0.05).geometry;
  EXPECT_LE(grid.width_cells, (kPlaceSightM + 10.0) / 0.05);
  const SeenPlace seen = SeenFrom(frames, {0}, 0, {});
  EXPECT_EQ(seen.points.size(), 1U);
  EXPECT_LE(seen.geometry.width_cells, (kPlaceSightM + 10.0) / 0.05);
}

// At 1 cm a sight of 80 m would need 3 GB a place.
TEST(Place, HasNoMoreCellsWhereTheyAreFiner) {
  Scan scan;
  scan.max_range_m = 80.0;
  for (const float range_m : {5.0F, 15.0F, 79.0F}) {
    const float bearing_rad = 0.1F * range_m;
    scan.beams.push_back(
        {.bearing_rad = bearing_rad, .range_m = range_m, .clear_to_m = range_m, .hit = true});
  }
  MappedFrame frame;
  frame.scan = ScanArchive().Keep(scan);
  const std::vector<MappedFrame> frames = {frame};
  OverlapOptions overlap;
  for (const auto& [resolution_m, seen_hits] : {std::pair{0.05, 3U}, {0.01, 2U}, {0.1, 3U}}) {
    SCOPED_TRACE(resolution_m);
    const double most_cells = 2.0 * kPlaceSightM / 0.05;
    EXPECT_EQ(PointsOfPlace(frames, {0}, 0, resolution_m).size(), seen_hits);
    const GridGeometry drawn = DrawPlace(frames, {0}, 0, resolution_m).geometry;
    EXPECT_LE(std::max(drawn.width_cells, drawn.height_cells), most_cells);
    overlap.resolution_m = resolution_m;
    const SeenPlace seen = SeenFrom(frames, {0}, 0, overlap);
    EXPECT_EQ(seen.points.size(), seen_hits);
    EXPECT_LE(std::max(seen.geometry.width_cells, seen.geometry.height_cells), most_cells);
  }
}

TEST(WallPyramid, SumsOfSquaresAreThoseOfEachSquare) {
  const std::vector<MappedFrame> frames = StraightOn(10);
  const WallPyramid walls(DrawPlace(frames, {0, 3, 6, 9}, 5, 0.05));
  RandomStream random(3, RandomStage::kTest);
  std::vector<Cell> cells;
  for (int i = 0; i < 300; ++i) {  // some of them far outside
    const double reach = i % 4 == 0 ? 1000.0 : 100.0;
    cells.push_back({static_cast<int>(random.Uniform(-reach, reach)),
                     static_cast<int>(random.Uniform(-reach, reach))});
  }
  const int level = walls.levels() - 1;
  int nonzero = 0;
  for (const int count : {1, 3, 4, 6}) {
    const Cell shift{-16 * count + 5, -16 * count - 3};
    const std::vector<int> sums = walls.SumsOfSquares(cells, shift, count);
    ASSERT_EQ(static_cast<int>(sums.size()), count * count);
    for (int i = 0; i < count * count; ++i) {
      const Cell square{shift.x + ((i % count) << level), shift.y + ((i / count) << level)};
      EXPECT_EQ(sums[static_cast<std::size_t>(i)], walls.Sum(cells, square, level, -1));
      nonzero += sums[static_cast<std::size_t>(i)] > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(nonzero, 20);
}

TEST(SeenPlace, OfAllIsTheSameWithAndWithoutHalves) {
  const std::vector<MappedFrame> frames = StraightOn(40);
  const OverlapOptions options;
  const std::vector<int> members = FramesOfPlace(frames, 20, options, 40), even{0, 10, 20, 30};
  ASSERT_EQ(members, (std::vector<int>{0, 5, 10, 15, 20, 25, 30, 35}));
  const SeenInHalves halves = SeenInHalvesFrom(frames, members, 20, options);
  const SeenPlace all = SeenFrom(frames, members, 20, options);
  EXPECT_EQ(halves.all.findings, all.findings);
  EXPECT_EQ(halves.all.geometry, all.geometry);
  EXPECT_EQ(halves.all.points, all.points);
  EXPECT_EQ(halves.even.findings, SeenFrom(frames, even, 20, options).findings);
  EXPECT_LT(halves.odd.points.size(), all.points.size());
}

// SLAM jumped far away after frame 19 and back before frame 30.
TEST(SeenPlace, EndsWhereSlamJumpedFarAway) {
  std::vector<MappedFrame> frames = StraightOn(40);
  for (int i = 20; i < 30; ++i) frames[static_cast<std::size_t>(i)].map_from_base.x_m += 3000.0;
  EXPECT_EQ(FramesOfPlace(frames, 15, {}, 40), (std::vector<int>{0, 5, 10, 15, 30, 35}));
  EXPECT_EQ(FramesOfPlace(frames, 24, {}, 40), (std::vector<int>{24, 29}));
}

// As every other scan of a place that has one; with a reach below a cell this once went on for
// ever.
TEST(SeenPlace, OfNoScansIsEmpty) {
  OverlapOptions options;
  options.tolerance_m = 0.0;
  EXPECT_TRUE(SeenFrom(StraightOn(1), {}, 0, options).points.empty());
}

// A wall counts for every cell within the tolerance and for none beyond.
TEST(SeenPlace, WallsReachAsFarAsTheTolerance) {
  const std::vector<MappedFrame> frames = StraightOn(1);
  OverlapOptions options;
  options.tolerance_m = 0.0;
  const SeenPlace thin = SeenFrom(frames, {0}, 0, options);
  options.tolerance_m = 0.1;
  const SeenPlace wide = SeenFrom(frames, {0}, 0, options);
  ASSERT_EQ(wide.geometry.width_cells, thin.geometry.width_cells + 4);
  for (std::size_t i = 0; i < wide.findings.size(); ++i) {
    const Cell cell = wide.geometry.CellAt(i);
    bool near = false;
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const Cell other{cell.x + dx, cell.y + dy};
        near = near || (thin.geometry.Contains(other) &&
                        thin.findings[thin.geometry.Index(other)] == SeenPlace::kWall);
      }
    }
    ASSERT_EQ(wide.findings[i] == SeenPlace::kWall, near);
  }
}

TEST(KnownPlaces, AreMadeAgainWhereTheFramesLieOtherwise) {
  std::vector<MappedFrame> frames = StraightOn(60);
  KnownPlaces places;
  const auto surfels = [&](int middle) {
    return &places.Of({frames, middle, {}, {}}).Surfels(frames);
  };
  const SurfelMap* const first = surfels(20);
  const SurfelMap* const second = surfels(30);
  EXPECT_EQ(surfels(20), first);
  EXPECT_EQ(surfels(30), second);
  const std::vector<Eigen::Vector2d> points = places.Of({frames, 20, {}, {}}).Points(frames);
  for (std::size_t i = 25; i < frames.size(); ++i) frames[i].map_from_base.x_m += 0.5;
  const std::vector<Eigen::Vector2d> moved = places.Of({frames, 20, {}, {}}).Points(frames);
  EXPECT_NE(moved, points);
  EXPECT_EQ(moved, KnownPlace(frames, 20, {}, {}).Points(frames));
}

}  // namespace
}  // namespace depthgrid
