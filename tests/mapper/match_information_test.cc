#include "mapper/match/match_information.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "mapper/grid/probability_grid.h"
#include "mapper/match/fast_match_cost.h"
#include "mapper/match/scan_matcher.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

TEST(InformationSums, FastAgreesWithPlain) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  RandomStream random(31, RandomStage::kTest);
  FastMatchCost cost;
  const MatchInformationOptions options;
  int cases = 0;
  for (; cases < 100; ++cases) {
    PlanarLaser laser;
    laser.beams = 50 + 7 * cases;
    laser.sigma_of_range = 0.01;
    const Pose2 pose{random.Uniform(1.5, 3.5), random.Uniform(0.8, 2.2), random.Uniform(-kPi, kPi)};
    MatchPoints points;
    points.Assign(ScanOf(room, pose, laser, 1, static_cast<std::uint32_t>(cases)));
    cost.Prepare(points, ViewOf(map), pose);
    const InformationSums a = cost.SumUp(pose, options);
    const InformationSums b = SumUpInformation(points, ViewOf(map), pose, options);
    EXPECT_LT((a.curvature - b.curvature).norm(), 1e-3 * b.curvature.norm());
    EXPECT_LT((a.curvature_along_walls - b.curvature_along_walls).norm(),
              1e-3 * b.curvature_along_walls.norm());
    EXPECT_LT((a.gradient_covariance - b.gradient_covariance).norm(),
              1e-3 * b.gradient_covariance.norm());
    EXPECT_LE(std::abs(a.explained - b.explained), 1);
    EXPECT_LT((cost.Evaluate(pose).hessian * points.size() - a.curvature).norm(),
              1e-4 * a.curvature.norm());
  }
  EXPECT_EQ(cases, 100);
}

Eigen::Matrix3d InformationAt(const MatchPoints& points, const OccupancyMap& map, const Pose2& pose,
                              const MatchInformationOptions& options = {}) {
  return MatchInformation(SumUpInformation(points, ViewOf(map), pose, options), pose, options);
}

// Scans with noise along a corridor, inserted at their true poses: what a mapper would have.
OccupancyMap CorridorMap(const PlanarWorld& corridor, const Pose2& world_from_corridor,
                         const PlanarLaser& laser) {
  ProbabilityGrid grid({});
  for (int k = 0; k < 60; ++k) {
    const Pose2 pose = world_from_corridor *
                       Pose2{0.03 * k - 0.9, 0.1 * std::sin(0.1 * k), 0.2 * std::sin(0.05 * k)};
    grid.Insert(CellsOfScanPlain(SegmentBuilder().Build(
        ScanOf(corridor, pose, laser, 1, static_cast<std::uint32_t>(k)), pose, 0.05)));
  }
  return grid.map();
}

TEST(MatchInformation, IsElongatedAlongACorridor) {
  int cases = 0;
  for (const double heading_rad : {0.0, 0.37}) {
    const Pose2 world_from_corridor{0.013, 0.021, heading_rad};
    PlanarWorld corridor = StraightCorridor();
    for (Wall& wall : corridor) {
      wall = {world_from_corridor * wall.from, world_from_corridor * wall.to};
    }
    PlanarLaser laser;
    laser.beams = 320;
    laser.sigma_of_range = 0.01;
    const OccupancyMap map = CorridorMap(corridor, world_from_corridor, laser);
    ScanMatcher matcher({});
    RandomStream random(32, RandomStage::kTest);
    for (int k = 0; k < 30; ++k, ++cases) {
      const Pose2 truth =
          world_from_corridor *
          Pose2{random.Uniform(-0.5, 0.5), random.Uniform(-0.1, 0.1), random.Uniform(-0.2, 0.2)};
      const Scan scan = ScanOf(corridor, truth, laser, 2, static_cast<std::uint32_t>(k));
      const MatchResult match = matcher.Match(scan, ViewOf(map), truth * Pose2{0.0, 0.02, 0.01});
      ASSERT_TRUE(match.found);
      const double yaw_rad = truth.yaw_rad - heading_rad;
      const Eigen::Vector2d along(std::cos(yaw_rad), -std::sin(yaw_rad));
      const Eigen::Vector2d across(std::sin(yaw_rad), std::cos(yaw_rad));
      const Eigen::Matrix2d xy = match.information.topLeftCorner<2, 2>();
      // Standard deviation along over across.
      const double ratio2 = across.dot(xy * across) / std::max(along.dot(xy * along), 1e-9);
      EXPECT_GT(ratio2, 10.0 * 10.0) << "case " << cases;
      const Pose2 error = Between(truth, match.map_from_base);
      EXPECT_LT(std::abs(across.dot(error.translation())), 0.03);
      EXPECT_LT(std::abs(error.yaw_rad), 0.02);
    }
  }
  EXPECT_EQ(cases, 60);
}

TEST(MatchInformation, AnExactCorridorHasNoneAlongIt) {
  const PlanarWorld corridor = StraightCorridor();
  const OccupancyMap map = SmoothMap(corridor, {-8.0, -1.5}, {8.0, 1.5}, 0.05);
  ScanMatcher matcher({});
  const Pose2 truth{0.1, 0.05, 0.1};
  const Pose2 predicted{0.17, 0.03, 0.12};
  const MatchResult match = matcher.Match(ScanOf(corridor, truth, {}), ViewOf(map), predicted);
  ASSERT_TRUE(match.found);
  const Eigen::Vector3d along(std::cos(truth.yaw_rad), -std::sin(truth.yaw_rad), 0.0);
  EXPECT_LT(along.dot(match.information * along), 1e-6 * match.information.norm());
  // What the scan does not see is the prediction's, what it sees is not.
  EXPECT_NEAR(match.map_from_base.x_m, predicted.x_m, 3e-3);
  EXPECT_NEAR(match.map_from_base.y_m, truth.y_m, 3e-3);
  EXPECT_NEAR(match.map_from_base.yaw_rad, truth.yaw_rad, 2e-3);
}

TEST(MatchInformation, WeakDirectionsAreLeftOut) {
  // Known to 1 cm across and 1 mrad, to 5 cm along an axis at 30 degrees.
  const Eigen::AngleAxisd turn(kPi / 6.0, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d known{1.0 / (0.05 * 0.05), 1.0 / (0.01 * 0.01), 1e6};
  const Eigen::Matrix3d information = turn * known.asDiagonal() * turn.inverse();
  EXPECT_EQ(WithoutWeakDirections(information, 0.06, 2.0), information);
  const Eigen::Matrix3d left = WithoutWeakDirections(information, 0.04, 2.0);
  const Eigen::Vector3d along = turn * Eigen::Vector3d::UnitX();
  EXPECT_LT((left * along).norm(), 1e-6);
  EXPECT_LT((left - information + known.x() * along * along.transpose()).norm(), 1e-6);
  EXPECT_TRUE(WithoutWeakDirections(Eigen::Matrix3d::Zero(), 0.04, 2.0).isZero(0.0));
}

TEST(MatchInformation, NothingSeenIsNoInformation) {
  const OccupancyMap map;
  MatchPoints points;
  points.x_m = {1.0F, 2.0F};
  points.y_m = {0.0F, 0.0F};
  points.farthest_m = 2.0F;
  EXPECT_TRUE(InformationAt(points, map, {}).isZero(0.0));
  EXPECT_TRUE(MatchInformation({}, {}, {}).isZero(0.0));
}

TEST(MatchInformation, RotatingTheWorldChangesNothing) {
  // By a quarter turn, which maps cells onto cells.
  PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  const Pose2 pose{3.0, 1.5, 0.4};
  MatchPoints points;
  points.Assign(ScanOf(room, pose, {}));
  const Pose2 turn{0.0, 0.0, kPi / 2};
  for (Wall& wall : room) wall = {turn * wall.from, turn * wall.to};
  const OccupancyMap turned = SmoothMap(room, {-5.5, -0.5}, {0.5, 6.5}, 0.05);
  const Eigen::Matrix3d a = InformationAt(points, map, pose);
  const Eigen::Matrix3d b = InformationAt(points, turned, turn * pose);
  EXPECT_LT((a - b).norm(), 1e-4 * a.norm());
}

// Noise of the scan alone, on an exact map: without map error the believed covariance must be that
// of the spread of the matched poses.
TEST(MatchInformation, AgreesWithMonteCarloOfScanNoise) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  PlanarLaser laser;
  laser.field_of_view_rad = RadFromDeg(90.0);
  laser.beams = 320;
  laser.sigma_of_range = 0.005;
  ScanMatcherOptions options;
  options.information.map_sigma_m = 0.0;
  options.information.wall_direction_sigma_rad = 0.0;
  options.information.patch_m = 0.0;  // the noise of the beams is independent
  ScanMatcher matcher(options);
  int places = 0;
  for (const Pose2& truth : {Pose2{3.0, 1.5, 0.3}, Pose2{2.2, 2.0, 2.2}, Pose2{3.3, 1.1, -2.6}}) {
    constexpr int kDraws = 300;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (int k = 0; k < kDraws; ++k) {
      const Scan scan = ScanOf(room, truth, laser, 3, static_cast<std::uint32_t>(k));
      const MatchResult match = matcher.Match(scan, ViewOf(map), truth);
      ASSERT_TRUE(match.found);
      const Eigen::Vector3d error = Between(truth, match.map_from_base).vector();
      mean += error / kDraws;
      square += error * error.transpose() / kDraws;
      information += match.information / kDraws;
    }
    const Eigen::Matrix3d spread = square - mean * mean.transpose();
    // 1 in every direction for a perfect estimate.
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> ratio(spread,
                                                                          information.inverse());
    EXPECT_GT(ratio.eigenvalues()(0), 0.5);
    EXPECT_LT(ratio.eigenvalues()(2), 2.0);
    ++places;
  }
  EXPECT_EQ(places, 3);
}

}  // namespace
}  // namespace depthgrid
