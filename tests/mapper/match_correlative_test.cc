#include <gtest/gtest.h>

#include "mapper/match/correlative_search.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

MatchPoints PointsOf(const Scan& scan) {
  MatchPoints points;
  points.Assign(scan);
  return points;
}

// Every cell drawn at random from a few values, some never seen: ties are common.
OccupancyMap MapWithTies(RandomStream& random, double resolution_m) {
  GridGeometry geometry;
  geometry.resolution_m = resolution_m;
  geometry.min_cell = {static_cast<int>(random.Below(80)) - 40,
                       static_cast<int>(random.Below(80)) - 40};
  geometry.width_cells = static_cast<int>(random.Below(150));
  geometry.height_cells = 1 + static_cast<int>(random.Below(150));
  OccupancyMap map(geometry);
  for (float& prob : map.occupied_prob) {
    const std::uint64_t draw = random.Below(5);
    prob = draw == 0 ? kUnknownProb : 0.1F + 0.2F * static_cast<float>(draw);
  }
  return map;
}

MatchPoints PointsInView(RandomStream& random, int count) {
  MatchPoints points;
  for (int i = 0; i < count; ++i) {
    const double range_m = random.Uniform(0.4, 6.0);
    const double bearing_rad = random.Uniform(-0.6, 0.6);
    points.x_m.push_back(static_cast<float>(range_m * std::cos(bearing_rad)));
    points.y_m.push_back(static_cast<float>(range_m * std::sin(bearing_rad)));
    points.farthest_m = std::max(points.farthest_m, static_cast<float>(range_m));
  }
  return points;
}

TEST(SearchLattice, StepMovesTheFarthestPointByOneCell) {
  const SearchLattice lattice = MakeLattice({}, 0.1, RadFromDeg(20.0), 0.05, 6.0);
  EXPECT_EQ(lattice.half_cells, 2);
  EXPECT_NEAR(2.0 * 6.0 * std::sin(0.5 * lattice.yaw_step_rad), 0.05, 1e-4);
  EXPECT_EQ(lattice.half_yaw_steps, 42);  // ceil(0.349 / 0.00833)
}

TEST(SearchLattice, ScoreByHand) {
  OccupancyMap map({.resolution_m = 0.5, .min_cell = {0, 0}, .width_cells = 3, .height_cells = 1});
  map.occupied_prob = {0.2F, 1.0F, kUnknownProb};
  MatchPoints points;
  points.x_m = {0.1F, 0.6F};
  points.y_m = {0.0F, 0.0F};
  points.farthest_m = 0.6F;
  const SearchLattice lattice = MakeLattice({0.1, 0.1, 0.0}, 0.5, 0.0, 0.5, 0.6);
  EXPECT_EQ(LatticeScore(lattice, {0, 0, 0}, points, ViewOf(map)), 205U + 1023U);
  EXPECT_EQ(LatticeScore(lattice, {1, 0, 0}, points, ViewOf(map)), 1023U + 512U);
  EXPECT_EQ(LatticeScore(lattice, {0, 1, 0}, points, ViewOf(map)), 512U + 512U);
}

TEST(CorrelativeSearch, FastEqualsExhaustiveOnRandomMaps) {
  RandomStream random(11, RandomStage::kTest);
  int cases = 0;
  for (; cases < 300; ++cases) {
    const double resolution_m = cases % 3 == 0 ? 0.1 : 0.05;
    const OccupancyMap map = MapWithTies(random, resolution_m);
    const MatchPoints points = PointsInView(random, 1 + static_cast<int>(random.Below(300)));
    const Pose2 predicted{random.Uniform(-6.0, 6.0), random.Uniform(-6.0, 6.0),
                          random.Uniform(-kPi, kPi)};
    CorrelativeOptions options;
    options.window_m = random.Uniform(0.0, cases % 10 == 0 ? 1.2 : 0.3);
    options.window_deg = random.Uniform(0.0, 4.0);
    if (cases % 4 == 0) {
      options.translation_cost_per_m = random.Uniform(0.0, 10.0);
      options.rotation_cost_per_rad = random.Uniform(0.0, 10.0);
    }
    CorrelativeSearch fast(options);
    options.method = SearchMethod::kReference;
    CorrelativeSearch reference(options);
    const CorrelativeMatch a = fast.Search(points, ViewOf(map), predicted);
    const CorrelativeMatch b = reference.Search(points, ViewOf(map), predicted);
    ASSERT_TRUE(a.found && b.found);
    EXPECT_EQ(a.step, b.step) << "case " << cases;
    EXPECT_EQ(a.score, b.score) << "case " << cases;
    EXPECT_EQ(a.map_from_base, b.map_from_base);
  }
  EXPECT_EQ(cases, 300);
}

TEST(CorrelativeSearch, FastEqualsExhaustiveInARoom) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  RandomStream random(12, RandomStage::kTest);
  PlanarLaser laser;
  laser.sigma_of_range = 0.01;
  CorrelativeOptions options;
  options.window_deg = 20.0;
  CorrelativeSearch fast(options);  // one for all, so that what it keeps is used again
  options.method = SearchMethod::kReference;
  CorrelativeSearch reference(options);
  int cases = 0;
  for (; cases < 20; ++cases) {
    laser.beams = cases % 2 == 0 ? 640 : 100;
    const Pose2 truth{random.Uniform(1.5, 3.5), random.Uniform(0.8, 2.2),
                      random.Uniform(-kPi, kPi)};
    const MatchPoints points =
        PointsOf(ScanOf(room, truth, laser, 1, static_cast<std::uint32_t>(cases)));
    const Pose2 predicted = truth * Pose2{0.06, -0.04, RadFromDeg(random.Uniform(-19.0, 19.0))};
    const CorrelativeMatch a = fast.Search(points, ViewOf(map), predicted);
    const CorrelativeMatch b = reference.Search(points, ViewOf(map), predicted);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.score, b.score);
    // A narrow view hardly tells a rotation from a translation of a cell or two.
    const Pose2 error = Between(truth, a.map_from_base);
    EXPECT_LT(error.translation().norm(), 0.08) << "case " << cases;
    EXPECT_LT(std::abs(error.yaw_rad), RadFromDeg(3.0)) << "case " << cases;
  }
  EXPECT_EQ(cases, 20);
}

TEST(CorrelativeSearch, TiesGoToTheSmallestMotion) {
  // All cells alike: every candidate scores the same.
  OccupancyMap map(
      {.resolution_m = 0.05, .min_cell = {-500, -500}, .width_cells = 1000, .height_cells = 1000});
  std::fill(map.occupied_prob.begin(), map.occupied_prob.end(), 0.3F);
  RandomStream random(13, RandomStage::kTest);
  const MatchPoints points = PointsInView(random, 50);
  for (const SearchMethod method : {SearchMethod::kFast, SearchMethod::kReference}) {
    CorrelativeSearch search({.method = method});
    const CorrelativeMatch match = search.Search(points, ViewOf(map), {0.3, 0.2, 3.0});
    EXPECT_EQ(match.step, LatticeStep{});
  }
}

TEST(CorrelativeSearch, WrapsTheYaw) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  PlanarLaser laser;
  laser.field_of_view_rad = kPi;
  CorrelativeSearch search({});
  for (const double side : {-1.0, 1.0}) {
    const Pose2 truth{3.0, 1.5, WrapAngle(kPi + side * 0.01)};
    const Pose2 predicted{3.0, 1.5, WrapAngle(kPi - side * 0.03)};
    const CorrelativeMatch match =
        search.Search(PointsOf(ScanOf(room, truth, laser)), ViewOf(map), predicted);
    EXPECT_LT(std::abs(WrapAngle(match.map_from_base.yaw_rad - truth.yaw_rad)), 0.01);
    EXPECT_LE(std::abs(match.map_from_base.yaw_rad), kPi);
  }
}

}  // namespace
}  // namespace depthgrid
