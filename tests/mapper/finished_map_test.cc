// The map of a finished run, drawn from noisy scans.
#include "mapper/finished_map.h"

#include <gtest/gtest.h>

#include "mapper/core/angle.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/surfel/wall_ranges.h"
#include "tests/mapper/mapped_frame.h"

namespace depthgrid {
namespace {

// A room of 8 x 6 m, off the cells' borders, with a wall in it that is seen from both sides.
const PlanarWorld kNoisyRoom = [] {
  PlanarWorld world = RectangleWorld(0.02, 0.02, 8.02, 6.02);
  world.push_back({{3.52, 2.02}, {3.52, 4.02}});
  world.push_back({{3.62, 4.02}, {3.62, 2.02}});
  return world;
}();

// Once round the wall in the middle, with true poses.
std::vector<MappedFrame> RoundTheRoom(double sigma_of_range) {
  PlanarLaser laser;
  laser.beams = 360;
  laser.field_of_view_rad = RadFromDeg(180.0);
  laser.max_range_m = 12.0;
  laser.sigma_of_range = sigma_of_range;
  std::vector<MappedFrame> frames;
  for (int i = 0; i < 120; ++i) {
    const double way_rad = RadFromDeg(3.0 * i);
    const Pose2 pose{3.6 + 2.2 * std::cos(way_rad), 3.0 + 1.9 * std::sin(way_rad), 2.0 * way_rad};
    frames.push_back(MappedFrameAt(kNoisyRoom, laser, pose, pose, i));
  }
  return frames;
}

double DistanceToWalls(const Eigen::Vector2d& place_m) {
  double nearest_m = 1e9;
  for (const auto& wall : kNoisyRoom) {
    const Eigen::Vector2d along = wall.to - wall.from;
    const double share = std::clamp(along.dot(place_m - wall.from) / along.squaredNorm(), 0.0, 1.0);
    nearest_m = std::min(nearest_m, (place_m - wall.from - share * along).norm());
  }
  return nearest_m;
}

struct WallCells {
  int all = 0;
  int astray = 0;  // two cells from any wall or farther
};

WallCells WallCellsOf(const OccupancyMap& map) {
  WallCells cells;
  const GridGeometry& seen = map.geometry;
  for (int y = seen.min_cell.y; y < seen.min_cell.y + seen.height_cells; ++y) {
    for (int x = seen.min_cell.x; x < seen.min_cell.x + seen.width_cells; ++x) {
      if (StateOf(map.At({x, y})) != CellState::kOccupied) continue;
      ++cells.all;
      const Eigen::Vector2d centre_m = seen.resolution_m * Eigen::Vector2d(x + 0.5, y + 0.5);
      cells.astray += DistanceToWalls(centre_m) > 2.0 * seen.resolution_m ? 1 : 0;
    }
  }
  return cells;
}

OccupancyMap AsMeasured(const std::vector<MappedFrame>& frames) {
  MapDrawing drawing(GridOptions{});
  for (const MappedFrame& frame : frames) {
    drawing.Add(frame.frame, *frame.obstacles, frame.map_from_base);
  }
  return drawing.Map();
}

TEST(FinishedMap, NoisyHitsLieOnTheirWalls) {
  const std::vector<MappedFrame> frames = RoundTheRoom(0.03);
  const WallCells measured = WallCellsOf(AsMeasured(frames));
  EXPECT_GT(measured.astray, 0.2 * measured.all);
  const WallCells drawn = WallCellsOf(DrawFinished(frames, {}));
  EXPECT_LT(drawn.astray, 0.02 * drawn.all);
  // 32 m of walls in cells of 5 cm.
  EXPECT_GT(drawn.all, 500);
}

TEST(FinishedMap, WhereNoiseStaysWithinACellOrIsToStayItIsAsMeasured) {
  const std::vector<MappedFrame> calm = RoundTheRoom(0.002);
  EXPECT_FALSE(IsSharpened(calm, {}));
  EXPECT_TRUE(StatesOf(DrawFinished(calm, {})) == StatesOf(AsMeasured(calm)));
  const std::vector<MappedFrame> noisy = RoundTheRoom(0.03);
  EXPECT_TRUE(IsSharpened(noisy, {}));
  GridOptions off;
  off.sharpen_sigmas = 0.0;
  EXPECT_FALSE(IsSharpened(noisy, off));
  EXPECT_TRUE(StatesOf(DrawFinished(noisy, off)) == StatesOf(AsMeasured(noisy)));
}

// Of a camera what is drawn was met at other heights than what is matched.
TEST(FinishedMap, ACamerasObstaclesAreDrawnAsMeasured) {
  std::vector<MappedFrame> frames = RoundTheRoom(0.03);
  for (MappedFrame& frame : frames) {
    Scan nearer = *frame.scan;
    for (Beam& beam : nearer.beams) beam.range_m *= 0.9F;
    frame.obstacles = ScanArchive().Keep(nearer);
    EXPECT_FALSE(DrawsWhatItMatches(frame));
  }
  EXPECT_TRUE(StatesOf(DrawFinished(frames, {})) == StatesOf(AsMeasured(frames)));
}

// What moves is left out of what is matched, and drawn.
TEST(FinishedMap, HitsOfNoWallStay) {
  std::vector<MappedFrame> frames = RoundTheRoom(0.03);
  const LaserNoise noise(frames);
  EXPECT_NEAR(noise.SigmaM(4.0), 0.12, 0.03);
  const WallRanges walls(frames, noise, 0.05, 4.0);
  Scan scan = *frames[0].scan;
  Scan matched = scan;
  Beam& free = scan.beams[180];
  free.range_m = 0.4F * free.range_m;
  free.clear_to_m = free.range_m;
  matched.beams[180] = Silent(free);
  frames[0].obstacles = ScanArchive().Keep(scan);
  frames[0].scan = ScanArchive().Keep(matched);
  EXPECT_TRUE(DrawsWhatItMatches(frames[0]));
  const Scan sharp = walls.Sharpened(scan, frames[0].map_from_base);
  EXPECT_EQ(sharp.beams[180], free);
  EXPECT_NE(sharp.beams[100].range_m, scan.beams[100].range_m);
  EXPECT_EQ(sharp.beams[100].clear_to_m, sharp.beams[100].range_m);
}

}  // namespace
}  // namespace depthgrid
