#include "eval/doubts/crossing_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

constexpr double kWallM = 2.02;  // the wall ahead: x of its face

// 161 beams over 80 degrees towards a wall at x = `wall_m`, with noise as a share of the range.
Scan ScanOfWall(double wall_m, double noise_share = 0.0, int seed = 1) {
  RandomStream random(static_cast<std::uint64_t>(seed), RandomStage::kTest);
  Scan scan;
  scan.max_range_m = 6.0;
  for (int i = -80; i <= 80; ++i) {
    const double bearing_rad = RadFromDeg(0.5 * i);
    const double range_m = wall_m / std::cos(bearing_rad) * (1.0 + noise_share * random.Normal());
    Beam beam;
    beam.bearing_rad = static_cast<float>(bearing_rad);
    beam.range_m = beam.clear_to_m = static_cast<float>(range_m);
    beam.hit = true;
    scan.beams.push_back(beam);
  }
  return scan;
}

// Free from x = 0 on, with walls along y in the cells that these x lie in.
OccupancyMap MapWithWalls(const std::vector<double>& walls_m) {
  OccupancyMap map({0.05, {-10, -100}, 120, 200});
  std::fill(map.occupied_prob.begin(), map.occupied_prob.end(), 0.1F);
  for (const double x_m : walls_m) {
    for (int y = -100; y < 100; ++y) {
      map.occupied_prob[map.geometry.Index({CellIndex(x_m, 0.05), y})] = 0.9F;
    }
  }
  return map;
}

MapperResult ResultOf(const std::vector<Scan>& scans, const OccupancyMap& map) {
  MapperResult result;
  ScanArchive archive;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    MappedFrame frame;
    frame.frame = static_cast<int>(10 + i);
    frame.scan = frame.obstacles = archive.Keep(scans[i]);
    result.mapped.push_back(frame);
  }
  result.map = map;
  return result;
}

double ShareOf(const MapperResult& result) { return CrossingOf(result)->share; }

TEST(CrossingCheck, ScansCrossNoneOfTheirOwn) {
  const auto crossing = CrossingOf(ResultOf({ScanOfWall(kWallM)}, MapWithWalls({kWallM})));
  ASSERT_TRUE(crossing.has_value());
  EXPECT_EQ(crossing->beams, 80);  // every second one, as there are more than 160
  EXPECT_EQ(crossing->share, 0.0);
  EXPECT_FALSE(crossing->worst_frame.has_value());
  EXPECT_FALSE(DoubtOfCrossing(*crossing).has_value());
}

TEST(CrossingCheck, AWallDrawnTwiceIsCrossedByTheScansOfTheFartherOne) {
  const OccupancyMap twice = MapWithWalls({kWallM - 0.3, kWallM});
  const std::vector<Scan> scans = {ScanOfWall(kWallM - 0.3), ScanOfWall(kWallM),
                                   ScanOfWall(kWallM - 0.3)};
  const auto crossing = CrossingOf(ResultOf(scans, twice));
  ASSERT_TRUE(crossing.has_value());
  EXPECT_NEAR(crossing->share, 1.0 / 3.0, 0.01);
  EXPECT_EQ(crossing->worst_frame, 11);
  const auto doubt = DoubtOfCrossing(*crossing);
  ASSERT_TRUE(doubt.has_value());
  EXPECT_NE(doubt->find("33.3 % of the beams"), std::string::npos) << *doubt;
  EXPECT_NE(doubt->find("around frame 11)"), std::string::npos) << *doubt;
  EXPECT_NE(doubt->find("or the camera's focal length"), std::string::npos) << *doubt;
  const auto of_laser = DoubtOfCrossing(*crossing, false);
  ASSERT_TRUE(of_laser.has_value());
  EXPECT_NE(of_laser->find("poses, or the laser's angles"), std::string::npos) << *of_laser;
  // Two cells are within the tolerance.
  EXPECT_EQ(ShareOf(ResultOf({ScanOfWall(kWallM)}, MapWithWalls({kWallM - 0.05, kWallM}))), 0.0);
}

TEST(CrossingCheck, NoiseOfTheBeamsIsNone) {
  for (const double noise_share : {0.01, 0.03, 0.1}) {
    std::vector<Scan> scans;
    for (int seed = 1; seed <= 20; ++seed) {
      scans.push_back(ScanOfWall(kWallM, noise_share, seed));
    }
    EXPECT_LT(ShareOf(ResultOf(scans, MapWithWalls({kWallM}))), 0.005) << noise_share;
  }
}

// Of a depth image whose neighbouring columns err alike: by a sixteenth of a degree, each eight.
TEST(CrossingCheck, NoiseThatNeighboursShareIsNone) {
  std::vector<Scan> scans;
  for (int seed = 1; seed <= 20; ++seed) {
    const Scan coarse = ScanOfWall(1.0, 0.05, seed);  // its ranges are 1 / cos and noise
    Scan scan;
    scan.max_range_m = 6.0;
    for (std::size_t i = 0; i < 8 * coarse.beams.size(); ++i) {
      Beam beam = coarse.beams[i / 8];
      const double error = beam.range_m * std::cos(beam.bearing_rad);
      beam.bearing_rad += static_cast<float>(RadFromDeg(0.0625 * static_cast<double>(i % 8)));
      beam.range_m = beam.clear_to_m =
          static_cast<float>(kWallM * error / std::cos(beam.bearing_rad));
      scan.beams.push_back(beam);
    }
    scans.push_back(scan);
  }
  EXPECT_LT(ShareOf(ResultOf(scans, MapWithWalls({kWallM}))), 0.01);
}

// A camera errs more the farther it sees, and most of its scans may be made nearby.
TEST(CrossingCheck, NoiseThatGrowsWithTheDistanceIsNone) {
  std::vector<Scan> scans;
  for (int seed = 1; seed <= 20; ++seed) {
    const bool is_far = seed % 4 == 0;
    scans.push_back(ScanOfWall(is_far ? 4.02 : 1.02, is_far ? 0.04 : 0.002, seed));
  }
  MapperResult result = ResultOf(scans, MapWithWalls({4.02}));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if ((i + 1) % 4 != 0) result.mapped[i].map_from_base.x_m = 3.0;
  }
  EXPECT_LT(ShareOf(result), 0.002);
}

TEST(CrossingCheck, SingleWrongReadingsAreNone) {
  Scan scan = ScanOfWall(kWallM);
  for (std::size_t i = 0; i < scan.beams.size(); i += 5) {
    scan.beams[i].range_m = scan.beams[i].clear_to_m = 3.0F;
  }
  EXPECT_EQ(ShareOf(ResultOf({scan}, MapWithWalls({kWallM}))), 0.0);
}

// A depth camera that looks over a chest in front of it knows nothing of the way below the image.
TEST(CrossingCheck, OnlyWhereTheBeamSaysThatTheWayIsFree) {
  Scan scan = ScanOfWall(kWallM);
  for (Beam& beam : scan.beams) beam.clear_from_m = 1.0F / std::cos(beam.bearing_rad);
  EXPECT_EQ(ShareOf(ResultOf({scan}, MapWithWalls({0.8, kWallM}))), 0.0);
  EXPECT_EQ(ShareOf(ResultOf({scan}, MapWithWalls({1.3, kWallM}))), 1.0);
}

// From afar a camera sees a table top, from nearby it looks over it at the wall. What is matched,
// at the camera's height, shows the wall alone.
TEST(CrossingCheck, OfACameraBothScansMustAgreeThatThereIsSome) {
  constexpr double kTableM = kWallM - 1.0;
  MapperResult result = ResultOf({ScanOfWall(kTableM), ScanOfWall(kWallM), ScanOfWall(kWallM)},
                                 MapWithWalls({kTableM, kWallM}));
  EXPECT_NEAR(ShareOf(result), 2.0 / 3.0, 0.01);
  ScanArchive archive;
  for (MappedFrame& frame : result.mapped) frame.scan = archive.Keep(ScanOfWall(kWallM));
  EXPECT_EQ(ShareOf(result), 0.0);
  // A wrong pose, from which the same wall seems to stand farther away.
  result.mapped[2].map_from_base.x_m = 0.5;
  EXPECT_GT(ShareOf(result), 0.1);
  // The map alone may be in order where what is matched is not, as with a shelf at the camera's
  // height that is seen from above at times.
  result.map = MapWithWalls({kWallM + 0.5});
  EXPECT_EQ(ShareOf(result), 0.0);
}

TEST(CrossingCheck, IsOfTheRunsOwnKeptScans) {
  MapperResult result = ResultOf({ScanOfWall(kWallM), ScanOfWall(kWallM)}, MapWithWalls({1.5}));
  EXPECT_EQ(ShareOf(result), 1.0);
  result.mapped[0].frame = -1;  // of the map that it went on in
  result.mapped[1].tied_to = 0;
  EXPECT_FALSE(CrossingOf(result).has_value());
  EXPECT_FALSE(DoubtOfCrossing(result).has_value());
  EXPECT_FALSE(CrossingOf({}).has_value());
  EXPECT_FALSE(CrossingOf(ResultOf({Scan{}}, OccupancyMap{})).has_value());
}

}  // namespace
}  // namespace depthgrid
