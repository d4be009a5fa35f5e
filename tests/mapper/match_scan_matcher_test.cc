#include <gtest/gtest.h>

#include <limits>

#include "mapper/match/scan_matcher.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr double kResolutionM = 0.05;

OccupancyMap RoomMap() {
  return SmoothMap(FurnishedRoom(), {-0.5, -0.5}, {6.5, 5.5}, kResolutionM);
}

Pose2 RandomFreePose(RandomStream& random) {
  return {random.Uniform(1.5, 3.5), random.Uniform(0.8, 2.2), random.Uniform(-kPi, kPi)};
}

TEST(ScanMatcher, RecoversKnownOffsets) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = RoomMap();
  RandomStream random(1, RandomStage::kTest);
  ScanMatcherOptions options;
  options.search.window_deg = 5.0;
  ScanMatcher matcher(options);
  PlanarLaser laser;
  laser.field_of_view_rad = RadFromDeg(180.0);
  double sum_m2 = 0.0;
  int cases = 0;
  for (; cases < 200; ++cases) {
    const Pose2 truth = RandomFreePose(random);
    const Scan scan = ScanOf(room, truth, laser);
    const Pose2 offset{random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1),
                       random.Uniform(-0.08, 0.08)};
    const MatchResult match = matcher.Match(scan, ViewOf(map), truth * offset);
    ASSERT_TRUE(match.found);
    const Pose2 error = Between(truth, match.map_from_base);
    EXPECT_LT(error.translation().norm(), 0.01) << "case " << cases;
    EXPECT_LT(std::abs(error.yaw_rad), RadFromDeg(0.3)) << "case " << cases;
    sum_m2 += error.translation().squaredNorm();
  }
  EXPECT_EQ(cases, 200);
  EXPECT_LT(std::sqrt(sum_m2 / cases), 0.005);
}

TEST(ScanMatcher, EmptyScanIsNotFound) {
  const OccupancyMap map = RoomMap();
  ScanMatcher matcher({});
  const Pose2 predicted{1.0, 2.0, 0.5};
  const MatchResult match = matcher.Match({}, ViewOf(map), predicted);
  EXPECT_FALSE(match.found);
  EXPECT_EQ(match.map_from_base, predicted);
  EXPECT_TRUE(match.information.isZero(0.0));
}

TEST(ScanMatcher, ScanOutsideTheMapIsNotFound) {
  const OccupancyMap map = RoomMap();
  const Scan scan = ScanOf(FurnishedRoom(), {3.0, 1.5, 0.0}, {});
  ScanMatcher matcher({});
  for (const double away_m : {7.0, 100.0, 1e9}) {
    EXPECT_FALSE(matcher.Match(scan, ViewOf(map), {away_m, 1.5, 0.0}).found);
  }
}

TEST(ScanMatcher, SurvivesWhatIsNotANumber) {
  const OccupancyMap map = RoomMap();
  const Pose2 truth{3.0, 1.5, 0.3};
  const Scan clean = ScanOf(FurnishedRoom(), truth, {});
  Scan dirty = clean;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -1.0F, 0.0F, 1e30F}) {
    dirty.beams.push_back({.bearing_rad = 0.5F, .range_m = bad, .hit = true});
  }
  dirty.beams.push_back({.bearing_rad = nan, .range_m = 1.0F, .hit = true});
  ScanMatcher matcher({});
  const MatchResult expected = matcher.Match(clean, ViewOf(map), truth);
  const MatchResult match = matcher.Match(dirty, ViewOf(map), truth);
  ASSERT_TRUE(match.found);
  EXPECT_EQ(match.map_from_base, expected.map_from_base);
  EXPECT_FALSE(matcher.Match(clean, ViewOf(map), {0.0, nan, 0.0}).found);
}

TEST(ScanMatcher, WorksAcrossTheWrapOfYaw) {
  const OccupancyMap map = RoomMap();
  PlanarLaser laser;
  laser.field_of_view_rad = kPi;
  ScanMatcher matcher({});
  for (const double truth_rad : {kPi, -kPi + 0.01, kPi - 0.02}) {
    for (const double offset_rad : {-0.05, -0.005, 0.005, 0.05}) {
      const Pose2 truth{3.0, 1.5, WrapAngle(truth_rad)};
      const Pose2 predicted{3.02, 1.49, WrapAngle(truth_rad + offset_rad)};
      const MatchResult match =
          matcher.Match(ScanOf(FurnishedRoom(), truth, laser), ViewOf(map), predicted);
      ASSERT_TRUE(match.found);
      const Pose2 error = Between(truth, match.map_from_base);
      EXPECT_LT(error.translation().norm(), 0.01);
      EXPECT_LT(std::abs(error.yaw_rad), 0.005);
      EXPECT_LE(std::abs(match.map_from_base.yaw_rad), kPi);
    }
  }
}

TEST(ScanMatcher, EveryMethodFindsTheSamePose) {
  const OccupancyMap map = RoomMap();
  RandomStream random(4, RandomStage::kTest);
  PlanarLaser laser;
  laser.beams = 200;
  laser.field_of_view_rad = kPi;
  laser.sigma_of_range = 0.01;
  ScanMatcher fast({});
  ScanMatcherOptions options;
  options.search.method = SearchMethod::kReference;
  options.least_squares.method = SolverMethod::kCeres;
  ScanMatcher reference(options);
  int cases = 0;
  for (; cases < 30; ++cases) {
    const Pose2 truth = RandomFreePose(random);
    const Scan scan = ScanOf(FurnishedRoom(), truth, laser, 7, static_cast<std::uint32_t>(cases));
    const Pose2 predicted = truth * Pose2{random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1),
                                          random.Uniform(-0.08, 0.08)};
    const MatchResult a = fast.Match(scan, ViewOf(map), predicted);
    const MatchResult b = reference.Match(scan, ViewOf(map), predicted);
    ASSERT_TRUE(a.found && b.found);
    const Pose2 difference = Between(a.map_from_base, b.map_from_base);
    EXPECT_LT(difference.translation().norm(), 1e-4) << "case " << cases;
    EXPECT_LT(std::abs(difference.yaw_rad), 1e-4) << "case " << cases;
    EXPECT_EQ(a.score, b.score);
  }
  EXPECT_EQ(cases, 30);
}

TEST(ScanMatcher, RepeatsItselfWhateverCameBefore) {
  const OccupancyMap map = RoomMap();
  const Pose2 truth{3.0, 1.5, 0.3};
  const Scan scan = ScanOf(FurnishedRoom(), truth, {});
  const Pose2 predicted = truth * Pose2{0.05, -0.03, 0.02};
  ScanMatcher fresh({});
  const MatchResult expected = fresh.Match(scan, ViewOf(map), predicted);
  ScanMatcher used({});
  PlanarLaser other;
  other.beams = 1000;
  other.field_of_view_rad = 2.0 * kPi;
  used.Match(ScanOf(FurnishedRoom(), {2.0, 1.0, 2.0}, other), ViewOf(map), {2.0, 1.0, 2.0});
  const MatchResult again = used.Match(scan, ViewOf(map), predicted);
  EXPECT_EQ(again.map_from_base, expected.map_from_base);
  EXPECT_EQ(again.information, expected.information);
  EXPECT_EQ(again.score, expected.score);
}

// One wall in front: forward and yaw are seen, sideways is not.
TEST(ScanMatcher, ALoneWallLeavesTheWayAlongItToThePrediction) {
  const PlanarWorld wall = {{{2.02, -20.0}, {2.02, 20.0}}};
  const OccupancyMap map = SmoothMap(wall, {-1.0, -6.0}, {3.0, 6.0}, 0.05);
  ScanMatcher matcher({});
  const Pose2 truth{0.0, 0.0, 0.0};
  const Pose2 predicted{0.05, 0.07, 0.02};
  const MatchResult match = matcher.Match(ScanOf(wall, truth, {}), ViewOf(map), predicted);
  ASSERT_TRUE(match.found);
  EXPECT_NEAR(match.map_from_base.x_m, truth.x_m, 4e-3);  // of the interpolated ridge
  EXPECT_NEAR(match.map_from_base.y_m, predicted.y_m, 3e-3);
  EXPECT_NEAR(match.map_from_base.yaw_rad, truth.yaw_rad, 1e-3);
  EXPECT_LT(match.information(1, 1), 1e-3 * match.information(0, 0));
}

}  // namespace
}  // namespace depthgrid
