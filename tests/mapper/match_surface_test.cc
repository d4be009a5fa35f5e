#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "mapper/match/scan_matcher.h"
#include "mapper/match/score_surface.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

TEST(ScoreSurface, HoldsEveryScore) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  PlanarLaser laser;
  laser.beams = 70;
  MatchPoints points;
  const Pose2 pose{2.9, 1.4, 2.9};
  points.Assign(ScanOf(room, pose, laser));
  LatticeScorer scorer;
  ScoreSurface surface;
  const SearchLattice lattice = MakeLattice(pose, 0.15, 0.02, 0.05, points.farthest_m);
  ScoreAll(lattice, points, ViewOf(map), scorer, surface);
  int cases = 0;
  for (int yaw = -lattice.half_yaw_steps; yaw <= lattice.half_yaw_steps; ++yaw) {
    for (int y = -3; y <= 3; ++y) {
      for (int x = -3; x <= 3; ++x, ++cases) {
        const LatticeStep step{x, y, yaw};
        EXPECT_EQ(surface.sums[surface.Index(step)],
                  LatticeScore(lattice, step, points, ViewOf(map)));
      }
    }
  }
  EXPECT_EQ(static_cast<std::size_t>(cases), surface.sums.size());
}

// A window of 300 m in cells of 5 mm has more candidates than an int counts.
TEST(ScoreSurface, CountsCandidatesBeyondAnInt) {
  ScoreSurface surface;
  surface.lattice.half_cells = 30'000;
  surface.lattice.half_yaw_steps = 1;
  const std::size_t side = 60'001;
  EXPECT_EQ(surface.Index({-30'000, -30'000, -1}), 0U);
  EXPECT_EQ(surface.Index({0, 0, 0}), (3 * side * side - 1) / 2);
  EXPECT_EQ(surface.Index({30'000, 30'000, 1}), 3 * side * side - 1);
}

// A surface that is a Gaussian with given standard deviations in steps.
ScoreSurface GaussianSurface(const Pose2& pose, const Eigen::Vector3d& sigma_steps) {
  ScoreSurface surface;
  surface.lattice = MakeLattice(pose, 0.4, 0.2, 0.05, 4.0);
  const int half = surface.lattice.half_cells;
  const int turns = surface.lattice.half_yaw_steps;
  for (int yaw = -turns; yaw <= turns; ++yaw) {
    for (int y = -half; y <= half; ++y) {
      for (int x = -half; x <= half; ++x) {
        const double fall =
            0.5 * Eigen::Vector3d(x, y, yaw).cwiseQuotient(sigma_steps).squaredNorm();
        surface.sums.push_back(
            static_cast<std::uint32_t>(std::max(0.0, kMatchProbScale * (100.0 - fall))));
      }
    }
  }
  return surface;
}

TEST(SurfaceInformation, IsThatOfAGaussian) {
  const ScoreSurface surface = GaussianSurface({1.0, 2.0, 0.0}, {2.0, 1.5, 2.5});
  const Eigen::Matrix3d covariance = SurfaceInformation(surface, 1.0).inverse();
  const Eigen::Vector3d expected_m{2.0 * 0.05, 1.5 * 0.05, 2.5 * surface.lattice.yaw_step_rad};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::sqrt(covariance(i, i)) / expected_m(i), 1.0, 0.1) << i;
  }
}

TEST(SurfaceInformation, TurnsWithBase) {
  const Eigen::Vector3d sigma{2.0, 1.2, 2.0};
  const Eigen::Matrix3d ahead = SurfaceInformation(GaussianSurface({1.0, 2.0, 0.0}, sigma), 1.0);
  const Eigen::Matrix3d left = SurfaceInformation(GaussianSurface({1.0, 2.0, kPi / 2}, sigma), 1.0);
  EXPECT_NEAR(left(0, 0), ahead(1, 1), 1e-6 * ahead.norm());
  EXPECT_NEAR(left(1, 1), ahead(0, 0), 1e-6 * ahead.norm());
}

TEST(SurfaceInformation, AFlatDirectionHasNone) {
  const ScoreSurface surface = GaussianSurface({1.0, 2.0, 0.0}, {1e3, 1.0, 1.0});
  const Eigen::Matrix3d information = SurfaceInformation(surface, 1.0);
  EXPECT_NEAR(information(0, 0), 0.0, 1e-9 * information.norm());
  EXPECT_GT(information(1, 1), 1.0 / (0.1 * 0.1));
}

TEST(SurfaceInformation, IsElongatedAlongACorridor) {
  const PlanarWorld corridor = StraightCorridor();
  const OccupancyMap map = SmoothMap(corridor, {-8.0, -1.5}, {8.0, 1.5}, 0.05);
  ScanMatcherOptions options;
  options.information.source = InformationSource::kSurface;
  ScanMatcher matcher(options);
  const Pose2 truth{0.1, 0.05, 0.1};
  const Pose2 predicted{0.17, 0.03, 0.12};
  const MatchResult match = matcher.Match(ScanOf(corridor, truth, {}), ViewOf(map), predicted);
  ASSERT_TRUE(match.found);
  const Eigen::Vector3d along(std::cos(truth.yaw_rad), -std::sin(truth.yaw_rad), 0.0);
  const Eigen::Vector3d across(std::sin(truth.yaw_rad), std::cos(truth.yaw_rad), 0.0);
  EXPECT_LT(100.0 * along.dot(match.information * along), across.dot(match.information * across));
  EXPECT_NEAR(match.map_from_base.x_m, predicted.x_m, 5e-3);
}

// The surface is as coarse as its lattice: right within a factor, never far too sure.
TEST(SurfaceInformation, AgreesWithMonteCarloWithinItsCoarseness) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  PlanarLaser laser;
  laser.field_of_view_rad = RadFromDeg(90.0);
  laser.beams = 320;
  laser.sigma_of_range = 0.01;
  ScanMatcherOptions options;
  options.information.source = InformationSource::kSurface;
  ScanMatcher matcher(options);
  int places = 0;
  for (const Pose2& truth : {Pose2{3.0, 1.5, 0.3}, Pose2{2.2, 2.0, 2.2}, Pose2{3.3, 1.1, -2.6}}) {
    constexpr int kDraws = 60;
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (int k = 0; k < kDraws; ++k) {
      const Scan scan = ScanOf(room, truth, laser, 4, static_cast<std::uint32_t>(k));
      const MatchResult match = matcher.Match(scan, ViewOf(map), truth);
      ASSERT_TRUE(match.found);
      const Eigen::Vector3d error = Between(truth, match.map_from_base).vector();
      square += error * error.transpose() / kDraws;
      information += match.information / kDraws;
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> ratio(square,
                                                                          information.inverse());
    EXPECT_LT(ratio.eigenvalues()(2), 3.0);
    ++places;
  }
  EXPECT_EQ(places, 3);
}

}  // namespace
}  // namespace depthgrid
