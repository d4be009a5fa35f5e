#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "mapper/grid/probability_grid.h"
#include "mapper/grid/scan_rasterizer.h"
#include "mapper/match/bicubic.h"
#include "mapper/match/least_squares.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

OccupancyMap RandomMap(RandomStream& random, int width, int height) {
  OccupancyMap map(
      {.resolution_m = 0.05, .min_cell = {-30, 7}, .width_cells = width, .height_cells = height});
  for (float& prob : map.occupied_prob) {
    prob = random.Below(6) == 0 ? kUnknownProb : static_cast<float>(random.Uniform(0.1, 0.9));
  }
  return map;
}

MatchPoints RandomPoints(RandomStream& random, int count) {
  MatchPoints points;
  for (int i = 0; i < count; ++i) {
    points.x_m.push_back(static_cast<float>(random.Uniform(0.0, 3.0)));
    points.y_m.push_back(static_cast<float>(random.Uniform(-1.0, 2.0)));
    points.farthest_m = 3.7F;
  }
  return points;
}

TEST(Bicubic, MeetsCellCentresAndIsConstantInTheUnknown) {
  RandomStream random(21, RandomStage::kTest);
  const OccupancyMap map = RandomMap(random, 12, 9);
  const ProbabilityView view = ViewOf(map);
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    const Cell cell = map.geometry.CellAt(i);
    EXPECT_NEAR(SampleBicubic(view, CellCentre(cell, 0.05)).value, view.At(cell), 1e-6);
  }
  const BicubicSample far = SampleBicubic(view, {50.0, -50.0});
  EXPECT_NEAR(far.value, 0.5, 1e-15);
  EXPECT_NEAR(far.dx, 0.0, 1e-12);
}

TEST(Bicubic, DerivativesAreThoseOfTheValue) {
  RandomStream random(22, RandomStage::kTest);
  const OccupancyMap map = RandomMap(random, 20, 20);
  const ProbabilityView view = ViewOf(map);
  const double h = 1e-6;
  int cases = 0;
  for (; cases < 200; ++cases) {
    const Eigen::Vector2d p{random.Uniform(-1.7, -0.3), random.Uniform(0.2, 1.5)};
    const Eigen::Vector2d ex{h, 0.0};
    const Eigen::Vector2d ey{0.0, h};
    const BicubicSample m = SampleBicubic(view, p);
    EXPECT_EQ(BicubicValue(view, p), m.value);
    const BicubicSample xp = SampleBicubic(view, p + ex), xm = SampleBicubic(view, p - ex);
    const BicubicSample yp = SampleBicubic(view, p + ey), ym = SampleBicubic(view, p - ey);
    EXPECT_NEAR(m.dx, (xp.value - xm.value) / (2 * h), 1e-5);
    EXPECT_NEAR(m.dy, (yp.value - ym.value) / (2 * h), 1e-5);
    EXPECT_NEAR(m.dxx, (xp.dx - xm.dx) / (2 * h), 2e-1);  // of the order of 1e3 per m^2
    EXPECT_NEAR(m.dxy, (yp.dx - ym.dx) / (2 * h), 2e-1);
    EXPECT_NEAR(m.dyy, (yp.dy - ym.dy) / (2 * h), 2e-1);
  }
  EXPECT_EQ(cases, 200);
}

TEST(MatchCost, DerivativesAreThoseOfTheValue) {
  RandomStream random(23, RandomStage::kTest);
  const OccupancyMap map = RandomMap(random, 120, 120);
  int cases = 0;
  for (; cases < 50; ++cases) {
    const MatchPoints points = RandomPoints(random, 30);
    const Pose2 pose{random.Uniform(-1.0, 3.0), random.Uniform(0.5, 5.0),
                     random.Uniform(-kPi, kPi)};
    const MatchPrior prior{pose * Pose2{0.1, 0.2, 0.3}, 3.0, 2.0};
    const auto evaluate = [&](const Eigen::Vector3d& v) {
      MatchCost cost = EvaluateMatchCost(points, ViewOf(map), Pose2::FromVector(v));
      prior.AddTo(Pose2::FromVector(v), cost);
      return cost;
    };
    const MatchCost cost = evaluate(pose.vector());
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d h = 1e-6 * Eigen::Vector3d::Unit(i);
      const MatchCost plus = evaluate(pose.vector() + h);
      const MatchCost minus = evaluate(pose.vector() - h);
      EXPECT_NEAR(cost.gradient(i), (plus.value - minus.value) / 2e-6, 1e-4);
      const Eigen::Vector3d column = (plus.gradient - minus.gradient) / 2e-6;
      EXPECT_LT((cost.hessian.col(i) - column).norm(), 1e-4 * cost.hessian.norm() + 1e-2);
    }
  }
  EXPECT_EQ(cases, 50);
}

TEST(FastMatchCost, AgreesWithThePlainOne) {
  RandomStream random(24, RandomStage::kTest);
  FastMatchCost fast;
  int cases = 0;
  for (int i = 0; i < 60; ++i) {
    // Down to maps smaller than a square of cells, and partly or wholly out of sight.
    const OccupancyMap map =
        RandomMap(random, static_cast<int>(random.Below(120)), static_cast<int>(random.Below(120)));
    ProbabilityView view = ViewOf(map);
    view.unknown_prob = 0.3F;
    const MatchPoints points = RandomPoints(random, 1 + static_cast<int>(random.Below(40)));
    Pose2 pose{random.Uniform(-6.0, 6.0), random.Uniform(-3.0, 6.0), random.Uniform(-kPi, kPi)};
    fast.Prepare(points, view, pose);
    for (int k = 0; k < 6; ++k, ++cases) {
      const MatchCost a = fast.Evaluate(pose);
      const MatchCost b = EvaluateMatchCost(points, view, pose);
      EXPECT_NEAR(a.value, b.value, 1e-6);
      EXPECT_LT((a.gradient - b.gradient).norm(), 2e-4 * (1.0 + b.gradient.norm()));
      EXPECT_LT((a.hessian - b.hessian).norm(), 2e-4 * (1.0 + b.hessian.norm()));
      // Small steps, then ones that leave the copied part of the map.
      const double step_m = k < 3 ? 0.01 : 0.4;
      pose = pose * Pose2{random.Uniform(-step_m, step_m), random.Uniform(-step_m, step_m),
                          random.Uniform(-step_m, step_m)};
    }
  }
  EXPECT_EQ(cases, 360);
}

struct Solver {
  LeastSquaresOptions options;

  LeastSquaresMatch operator()(const MatchPoints& points, const ProbabilityView& view,
                               const Pose2& seed, const Pose2& predicted) const {
    FastMatchCost cost;
    cost.Prepare(points, view, seed);
    return SolveLeastSquares(options, cost, seed, predicted);
  }
};

struct SeededScan {
  MatchPoints points;
  Pose2 truth;
  Pose2 seed;
};

SeededScan RandomCase(const PlanarWorld& room, RandomStream& random, int number) {
  PlanarLaser laser;
  laser.beams = 160 + 160 * (number % 3);
  laser.field_of_view_rad = number % 2 == 0 ? RadFromDeg(58.0) : kPi;
  laser.sigma_of_range = 0.01;
  SeededScan scan;
  scan.truth = {random.Uniform(1.5, 3.5), random.Uniform(0.8, 2.2), random.Uniform(-kPi, kPi)};
  scan.points.Assign(ScanOf(room, scan.truth, laser, 5, static_cast<std::uint32_t>(number)));
  scan.seed = scan.truth * Pose2{random.Uniform(-0.02, 0.02), random.Uniform(-0.02, 0.02),
                                 random.Uniform(-0.01, 0.01)};
  return scan;
}

// The least curvature of the cost over the largest, metres and the arm's metres alike: without a
// second wall in view there is a direction without a minimum.
double Determinacy(const MatchPoints& points, const ProbabilityView& view, const Pose2& pose) {
  const double arm_m = 0.5 * points.farthest_m;
  const Eigen::Vector3d unscale{1.0, 1.0, 1.0 / arm_m};
  const Eigen::Matrix3d hessian =
      unscale.asDiagonal() * EvaluateMatchCost(points, view, pose).hessian * unscale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(hessian);
  return axes.eigenvalues()(0) / axes.eigenvalues()(2);
}

OccupancyMap ExactRoom() { return SmoothMap(FurnishedRoom(), {-0.5, -0.5}, {6.5, 5.5}, 0.05); }

// As a mapper would have it: rough, from noisy scans.
OccupancyMap MappedRoom() {
  ProbabilityGrid grid({});
  ScanRasterizer rasterizer;
  PlanarLaser laser;
  laser.field_of_view_rad = kPi;
  laser.sigma_of_range = 0.01;
  RandomStream random(28, RandomStage::kTest);
  for (int k = 0; k < 120; ++k) {
    const Pose2 pose{random.Uniform(1.5, 3.5), random.Uniform(0.8, 2.2), random.Uniform(-kPi, kPi)};
    grid.Insert(rasterizer.Rasterize(
        ScanOf(FurnishedRoom(), pose, laser, 6, static_cast<std::uint32_t>(k)), pose, 0.05));
  }
  return grid.map();
}

void ExpectSameMinimumAsCeres(const OccupancyMap& map, const LeastSquaresOptions& options) {
  RandomStream random(25, RandomStage::kTest);
  const Solver fast{options};
  LeastSquaresOptions slow = options;
  slow.method = SolverMethod::kCeres;
  slow.max_iterations = 500;
  const Solver ceres{slow};
  int cases = 0;
  int compared = 0;
  for (; cases < 200; ++cases) {
    const SeededScan c = RandomCase(FurnishedRoom(), random, cases);
    const Pose2 predicted = c.truth * Pose2{0.01, -0.01, 0.005};
    const LeastSquaresMatch a = fast(c.points, ViewOf(map), c.seed, predicted);
    const LeastSquaresMatch b = ceres(c.points, ViewOf(map), c.seed, predicted);
    ASSERT_TRUE(a.converged && b.converged) << "case " << cases;
    // Along a lone wall there is no minimum to agree on, and Gauss-Newton's long steps there can
    // end decimetres away in front of another one.
    const bool slid = Between(c.seed, b.map_from_base).translation().norm() > 0.1;
    if (slid || Determinacy(c.points, ViewOf(map), b.map_from_base) < 1e-3) continue;
    ++compared;
    const Pose2 difference = Between(b.map_from_base, a.map_from_base);
    EXPECT_LT(difference.translation().norm(), 1e-4) << "case " << cases;
    EXPECT_LT(std::abs(difference.yaw_rad), 1e-4) << "case " << cases;
  }
  EXPECT_EQ(cases, 200);
  EXPECT_GE(compared, 170);
}

TEST(LeastSquares, FindsTheMinimumThatCeresFinds) {
  ExpectSameMinimumAsCeres(ExactRoom(), {});
  ExpectSameMinimumAsCeres(MappedRoom(), {});
}

TEST(LeastSquares, FindsTheMinimumThatCeresFindsWithAPrior) {
  const LeastSquaresOptions options{.prior_translation_weight_per_m = 2.0,
                                    .prior_rotation_weight_per_rad = 3.0};
  ExpectSameMinimumAsCeres(ExactRoom(), options);
  ExpectSameMinimumAsCeres(MappedRoom(), options);
}

TEST(LeastSquares, AStrongPriorHoldsThePrediction) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  RandomStream random(26, RandomStage::kTest);
  const SeededScan c = RandomCase(room, random, 0);
  for (const SolverMethod method : {SolverMethod::kFast, SolverMethod::kCeres}) {
    const Solver solver{{.method = method,
                         .prior_translation_weight_per_m = 1e4,
                         .prior_rotation_weight_per_rad = 1e4}};
    const LeastSquaresMatch match = solver(c.points, ViewOf(map), c.seed, c.truth);
    const Pose2 error = Between(c.truth, match.map_from_base);
    EXPECT_LT(error.translation().norm() + std::abs(error.yaw_rad), 1e-5);
  }
}

TEST(LeastSquares, YawWrapsBetweenSeedAndPrediction) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  PlanarLaser laser;
  laser.field_of_view_rad = kPi;
  MatchPoints points;
  const Pose2 truth{3.0, 1.5, kPi};
  points.Assign(ScanOf(room, truth, laser));
  for (const SolverMethod method : {SolverMethod::kFast, SolverMethod::kCeres}) {
    const Solver solver{{.method = method,
                         .prior_translation_weight_per_m = 0.1,
                         .prior_rotation_weight_per_rad = 0.1}};
    for (const double side : {-1.0, 1.0}) {
      const Pose2 seed{3.0, 1.5, WrapAngle(kPi - side * 0.01)};
      const Pose2 predicted{3.0, 1.5, WrapAngle(kPi + side * 0.01)};
      const LeastSquaresMatch match = solver(points, ViewOf(map), seed, predicted);
      EXPECT_TRUE(match.converged);
      EXPECT_NEAR(WrapAngle(match.map_from_base.yaw_rad - truth.yaw_rad), 0.0, 2e-3);
    }
  }
}

TEST(LeastSquares, NothingButUnknownLeavesTheSeed) {
  const OccupancyMap map;
  RandomStream random(27, RandomStage::kTest);
  const MatchPoints points = RandomPoints(random, 20);
  const Solver solver{{}};
  const LeastSquaresMatch match = solver(points, ViewOf(map), {1.0, 2.0, 3.0}, {});
  EXPECT_NEAR((match.map_from_base.vector() - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 0.0, 1e-4);
}

}  // namespace
}  // namespace depthgrid
