#include "mapper/match/find_place.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/pose2.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

// An L-shaped room: no turn of it looks like another.
const std::vector<Wall> kWalls = {{{0, 0}, {6, 0}}, {{6, 0}, {6, 2}}, {{6, 2}, {3, 2}},
                                  {{3, 2}, {3, 5}}, {{3, 5}, {0, 5}}, {{0, 5}, {0, 0}}};

OccupancyMap Drawn(const std::vector<Wall>& walls = kWalls) {
  OccupancyMap map(GridGeometry{0.05, {-4, -4}, 130, 110});
  map.occupied_prob.assign(map.occupied_prob.size(), 0.1F);
  for (const Wall& wall : walls) {
    for (double share = 0.0; share <= 1.0; share += 0.002) {
      const Cell cell = CellOf(wall.from + share * (wall.to - wall.from), 0.05);
      map.occupied_prob[map.geometry.Index(cell)] = 0.9F;
    }
  }
  return map;
}

double RangeAlong(const Eigen::Vector2d& at, const Eigen::Vector2d& way,
                  const std::vector<Wall>& walls) {
  double nearest_m = 100.0;
  for (const Wall& wall : walls) {
    Eigen::Matrix2d a;
    a << way, wall.from - wall.to;
    if (std::abs(a.determinant()) < 1e-9) continue;
    const Eigen::Vector2d solved = a.inverse() * (wall.from - at);
    if (solved.x() > 0.0 && solved.y() >= 0.0 && solved.y() <= 1.0) {
      nearest_m = std::min(nearest_m, solved.x());
    }
  }
  return nearest_m;
}

// 58 degrees wide, as a depth camera's.
PlacedScan ScanAt(const Pose2& map_from_base, const Pose2& map_from_slam,
                  const std::vector<Wall>& walls = kWalls) {
  Scan scan;
  for (int i = -30; i <= 30; ++i) {
    Beam beam;
    beam.bearing_rad = static_cast<float>(RadFromDeg(i));
    const double angle_rad = map_from_base.yaw_rad + beam.bearing_rad;
    beam.range_m = static_cast<float>(RangeAlong(
        {map_from_base.x_m, map_from_base.y_m}, {std::cos(angle_rad), std::sin(angle_rad)}, walls));
    beam.hit = true;
    scan.beams.push_back(beam);
  }
  return {std::make_shared<const Scan>(scan), Inverse(map_from_slam) * map_from_base};
}

TEST(FindPlaceNear, AKnownPlaceIsLeftWhereTheScansFit) {
  const OccupancyMap map = Drawn();
  const Pose2 base{1.5, 1.0, 0.3};
  const std::vector<PlacedScan> scans = {ScanAt(base, {}), ScanAt(base * Pose2{0, 0, 1.5}, {})};
  const auto best = FindPlaceNear(map, scans, {0.02, 0.02, 0.0});
  ASSERT_TRUE(best);
  EXPECT_EQ(FitAt(map, scans, best->map_from_slam), best->score);
  const double best_x_m = best->map_from_slam.x_m;
  for (const double off_m : {0.0, 0.2}) {
    Pose2 known = best->map_from_slam;
    known.x_m += off_m;
    const double fit = FitAt(map, scans, known);
    EXPECT_EQ(FitsAsWell(fit, best->score), off_m == 0.0);
    EXPECT_NEAR(FindPlaceNear(map, scans, known)->map_from_slam.x_m, best_x_m,
                off_m == 0.0 ? 1e-9 : 0.04);
    EXPECT_NEAR(FindPlaceNear(map, scans, known, 0.0)->map_from_slam.x_m, known.x_m, 1e-9);
    EXPECT_NEAR(FindPlaceNear(map, scans, known, 0.1)->map_from_slam.x_m, known.x_m, 0.1);
  }
}

// Turning on the spot shows enough; SLAM's frame is anywhere.
TEST(FindPlace, FindsTheFrameOfThePosesFromAFewScans) {
  const OccupancyMap map = Drawn();
  RandomStream random(3, RandomStage::kTest);
  for (int trial = 0; trial < 3; ++trial) {
    const Pose2 map_from_slam{random.Uniform(-9, 9), random.Uniform(-9, 9), random.Uniform(-3, 3)};
    const Eigen::Vector2d at(random.Uniform(0.5, 2.5), random.Uniform(0.5, 4.5));
    std::vector<PlacedScan> scans;
    for (int i = 0; i < 5; ++i) {
      scans.push_back(ScanAt({at.x(), at.y(), WrapAngle(0.7 * i)}, map_from_slam));
    }
    const auto found = FindPlace(map, scans, Pose2{});
    ASSERT_TRUE(found);
    const Pose2 error = Between(map_from_slam * scans[0].slam_from_base,
                                found->map_from_slam * scans[0].slam_from_base);
    EXPECT_LT(std::hypot(error.x_m, error.y_m), 0.05);
    EXPECT_LT(std::abs(error.yaw_rad), RadFromDeg(2.0));
    EXPECT_GT(found->score, 0.8);
    // How far behind the second is depends on what the few scans show; up to 0.93 of the best here.
    EXPECT_LT(found->second_score, found->score);
    ASSERT_EQ(found->second.has_value(), found->second_score > 0.0);
    if (!found->second) continue;
    EXPECT_TRUE(IsElsewhere(*found->second * scans[0].slam_from_base,
                            found->map_from_slam * scans[0].slam_from_base));
    EXPECT_NEAR(FitAt(map, scans, *found->second), found->second_score, 1e-6);
  }
}

TEST(FindPlace, AGuessThatFitsIsKept) {
  const Pose2 map_from_slam{0.02, -0.01, 0.01};
  const auto found = FindPlace(Drawn(), {ScanAt({1.0, 1.0, 0.3}, map_from_slam)}, Pose2{});
  ASSERT_TRUE(found);
  EXPECT_LT(std::hypot(found->map_from_slam.x_m, found->map_from_slam.y_m), 0.1);
}

// A rectangle turned by half a turn is the same: only the guess says which, also when SLAM has
// drifted since.
TEST(FindPlace, TheGuessDecidesBetweenTwins) {
  const std::vector<Wall> rectangle = {
      {{0, 0}, {6, 0}}, {{6, 0}, {6, 4}}, {{6, 4}, {0, 4}}, {{0, 4}, {0, 0}}};
  const Pose2 map_from_slam{0.7, -0.5, 0.08};
  for (const Pose2& at : {Pose2{1.5, 1.0, 0.3}, Pose2{4.5, 3.0, 0.3 - kPi}}) {
    std::vector<PlacedScan> scans;
    for (int i = 0; i < 5; ++i) {
      scans.push_back(
          ScanAt({at.x_m, at.y_m, WrapAngle(at.yaw_rad + 0.7 * i)}, map_from_slam, rectangle));
    }
    const auto found = FindPlace(Drawn(rectangle), scans, Pose2{});
    ASSERT_TRUE(found);
    const Pose2 error = Between(map_from_slam, found->map_from_slam);
    EXPECT_LT(std::hypot(error.x_m, error.y_m), 0.15);
    EXPECT_LT(std::abs(error.yaw_rad), RadFromDeg(3.0));
  }
}

// In front of a plain wall all places along it look alike; a corner ends that.
TEST(FindPlace, SaysAlongWhichLineThePlaceIsNotKnown) {
  const Pose2 facing_a_wall{3.0, 1.0, -0.5 * kPi}, facing_a_corner{1.0, 1.0, -0.75 * kPi};
  const auto wall = FindPlace(Drawn(), {ScanAt(facing_a_wall, {})}, Pose2{});
  ASSERT_TRUE(wall && wall->unsure);
  EXPECT_LT(std::abs(std::sin(wall->unsure->direction_rad)), std::sin(RadFromDeg(6.0)));
  EXPECT_GT(wall->unsure->reach_m, 1.5);
  EXPECT_LT(wall->unsure->reach_m, 4.0);
  const auto corner = FindPlace(Drawn(), {ScanAt(facing_a_corner, {})}, Pose2{});
  ASSERT_TRUE(corner);
  EXPECT_FALSE(corner->unsure);
}

// What a return says that ends beyond the map costs no memory, nor do cells finer than the search.
TEST(FindPlace, AFarReturnAndAFineMapTakeNoMoreMemory) {
  OccupancyMap fine(GridGeometry{0.01, {-20, -20}, 650, 550});
  const OccupancyMap map = Drawn();
  for (std::size_t i = 0; i < fine.occupied_prob.size(); ++i) {
    const Cell cell = fine.geometry.CellAt(i);
    fine.occupied_prob[i] = map.At(CellOf(CellCentre(cell, 0.01), 0.05));
  }
  const Pose2 map_from_slam{0.4, -0.3, 0.5};
  std::vector<PlacedScan> scans;
  for (int i = 0; i < 5; ++i) {
    scans.push_back(ScanAt({1.2, 3.0, WrapAngle(0.7 * i)}, map_from_slam));
  }
  Scan with_a_far_one = *scans[0].scan;
  with_a_far_one.beams[3].range_m = 5000.0F;
  scans[0].scan = std::make_shared<const Scan>(with_a_far_one);
  for (const OccupancyMap& one : {map, fine}) {
    const auto found = FindPlace(one, scans, Pose2{});
    ASSERT_TRUE(found);
    const Pose2 error = Between(map_from_slam * scans[0].slam_from_base,
                                found->map_from_slam * scans[0].slam_from_base);
    EXPECT_LT(std::hypot(error.x_m, error.y_m), 0.05);
    EXPECT_LT(std::abs(error.yaw_rad), RadFromDeg(2.0));
  }
}

TEST(FindPlace, NothingToFind) {
  EXPECT_FALSE(FindPlace(Drawn(), {}, Pose2{}));
  EXPECT_FALSE(FindPlace(OccupancyMap(GridGeometry{0.05, {0, 0}, 20, 20}),
                         {ScanAt({1.0, 1.0, 0.3}, {})}, Pose2{}));
  EXPECT_FALSE(FindPlace(Drawn(), {{std::make_shared<const Scan>(), Pose2{}}}, Pose2{}));
}

}  // namespace
}  // namespace depthgrid
