#include "eval/metrics/map_registration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval/metrics/spline_field.h"
#include "eval/metrics/wall_distances.h"
#include "mapper/core/rng.h"
#include "tests/metrics/drawn_map.h"

namespace depthgrid {
namespace {

// Walls across the lattice: along it, cells know a wall to half a cell only, whoever reads them.
const Pose2 kWorldFromRoom{0.013, 0.021, 0.3};

TEST(SplineField, IsARidgeWithoutRipplesAlongAWall) {
  StateMap map(GridGeometry{0.05, {-2, 3}, 30, 9});
  for (int x = -2; x < 28; ++x) map.states[map.geometry.Index({x, 7})] = CellState::kOccupied;
  const SplineField field(CellsIn(map, CellState::kOccupied), 0);
  for (double x = 5.0; x < 20.0; x += 0.17) {
    EXPECT_NEAR(field.At({x, 7.5}).value, 2.0 / 3.0, 1e-12);  // the spline's height over its middle
    EXPECT_NEAR(field.At({x, 7.8}).gradient.x(), 0.0, 1e-12);
  }
  EXPECT_EQ(field.At({-100.0, 3.0}).value, 0.0);
}

TEST(SplineField, DerivativesAreThoseOfTheValue) {
  RandomStream random(3, RandomStage::kTest);
  CellSet set(GridGeometry{0.1, {-4, 2}, 12, 10});
  for (auto& member : set.members) member = random.Uniform() < 0.3;
  constexpr double kStep = 1e-5;
  for (const int radius : {0, 1, 2}) {
    const SplineField field(set, radius);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d p(random.Uniform(-8, 12), random.Uniform(-2, 16));
      const SplineSample s = field.At(p);
      for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector2d d = Eigen::Vector2d::Unit(axis) * kStep;
        const SplineSample up = field.At(p + d);
        const SplineSample down = field.At(p - d);
        EXPECT_NEAR(s.gradient(axis), (up.value - down.value) / (2 * kStep), 1e-8);
        EXPECT_NEAR(s.hessian(axis, 0), (up.gradient(0) - down.gradient(0)) / (2 * kStep), 1e-4);
        EXPECT_NEAR(s.hessian(axis, 1), (up.gradient(1) - down.gradient(1)) / (2 * kStep), 1e-4);
      }
    }
  }
}

std::optional<MapRegistration> Registered(const StateMap& truth, const StateMap& estimate) {
  return RegisterMap(truth, estimate, Everywhere(truth.geometry));
}

TEST(RegisterMap, TheSameMapStays) {
  const StateMap map = MovedRoom(kWorldFromRoom);
  const auto found = Registered(map, map);
  ASSERT_TRUE(found);
  // A fiftieth of a cell: walls that are no faces take part on one side only.
  EXPECT_NEAR(found->mean_shift_m, 0.0, 1e-3);
}

// Shifts of whole, half and odd parts of a cell, and turns: found to a fraction of a cell, half
// cells as well as whole ones.
TEST(RegisterMap, FindsWholeAndHalfCells) {
  const StateMap truth = MovedRoom(kWorldFromRoom);
  int found_motions = 0;
  double worst_m = 0.0;
  for (const double cells : {0.25, 0.5, 1.0, 1.5, 2.5, 4.0, 7.5}) {
    for (const double yaw_rad : {0.0, 0.02, -0.05}) {
      const Pose2 wrong{cells * 0.05, -0.7 * cells * 0.05, yaw_rad};
      const auto found = Registered(truth, MovedRoom(wrong * kWorldFromRoom));
      ASSERT_TRUE(found);
      // At the room's middle 6 mm, an eighth of a cell, and 4 mrad, the same at 1.5 m from it: both
      // maps know their walls to whole cells, and that much is left after averaging over walls.
      const Pose2 left = found->truth_from_estimate * wrong;
      const Eigen::Vector2d middle(2.0, 1.5);
      const double error_m = (left * middle - middle).norm();
      worst_m = std::max(worst_m, error_m);
      EXPECT_LT(error_m, 0.006) << cells << " cells, yaw " << yaw_rad;
      EXPECT_NEAR(left.yaw_rad, 0.0, 0.004) << cells << " cells, yaw " << yaw_rad;
      ++found_motions;
    }
  }
  EXPECT_EQ(found_motions, 21);
  RecordProperty("worst_mm", static_cast<int>(worst_m * 1000));
}

TEST(RegisterMap, SolidFurnitureDoesNotPullInwards) {
  StateMap truth = MovedRoom(kWorldFromRoom);
  const StateMap estimate = truth;
  // The cupboard solid, and the walls a few cells thick behind their faces, as truth grids have it.
  const CellSet free = CellsIn(truth, CellState::kFree);
  for (std::size_t i = 0; i < truth.states.size(); ++i) {
    if (truth.states[i] == CellState::kUnknown) truth.states[i] = CellState::kOccupied;
  }
  const auto found = Registered(truth, estimate);
  ASSERT_TRUE(found);
  EXPECT_LT(found->mean_shift_m, 0.003);
}

// One straight wall says nothing of the way along it: nothing may carry the map off there.
TEST(RegisterMap, StaysWhereTheWallsLeaveItOpen) {
  StateMap truth = MovedRoom(kWorldFromRoom);
  StateMap estimate(truth.geometry);
  CellSet seen(truth.geometry);
  const Pose2 room_from_world = Inverse(kWorldFromRoom);
  for (std::size_t i = 0; i < truth.states.size(); ++i) {
    const Eigen::Vector2d p = room_from_world * CellCentre(truth.geometry.CellAt(i), 0.05);
    if (p.x() < 0.5 || p.x() > 2.3 || p.y() > 0.6) continue;
    estimate.states[i] = truth.states[i];
    seen.members[i] = truth.states[i] != CellState::kUnknown;
  }
  const auto found = RegisterMap(truth, estimate, seen);
  ASSERT_TRUE(found);
  EXPECT_LT(found->mean_shift_m, 0.01);
}

// Nor where it lies beside the true wall: it comes straight to it.
TEST(RegisterMap, GoesStraightToAWallThatIsOpenAlong) {
  StateMap truth(GridGeometry{0.05, {0, 0}, 240, 60});
  StateMap estimate = truth;
  CellSet seen(truth.geometry);
  for (int x = 5; x < 235; ++x) {
    truth.states[truth.geometry.Index({x, 30})] = CellState::kOccupied;
    truth.states[truth.geometry.Index({x, 29})] = CellState::kFree;
    if (x < 60 || x > 180) continue;
    estimate.states[estimate.geometry.Index({x, 32})] = CellState::kOccupied;
    for (int y = 20; y < 40; ++y) seen.members[truth.geometry.Index({x, y})] = 1;
  }
  for (const CellSet& scored : {seen, Everywhere(truth.geometry)}) {
    const auto found = RegisterMap(truth, estimate, scored);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->truth_from_estimate.y_m, -0.10, 0.002);
    EXPECT_NEAR(found->truth_from_estimate.x_m, 0.0, 0.002);
    EXPECT_NEAR(found->truth_from_estimate.yaw_rad, 0.0, 1e-3);
  }
}

TEST(RegisterMap, NothingToLayOver) {
  const StateMap map = MovedRoom(kWorldFromRoom);
  EXPECT_FALSE(Registered(StateMap(map.geometry), map));
  EXPECT_FALSE(Registered(map, StateMap(map.geometry)));
}

// Walls of another place: no hill is in reach, which is not "lies as it should".
TEST(RegisterMap, NothingInReach) {
  StateMap truth(GridGeometry{0.05, {0, 0}, 200, 20});
  StateMap estimate = truth;
  for (int y = 0; y < 20; ++y) {
    truth.states[truth.geometry.Index({10, y})] = CellState::kOccupied;
    truth.states[truth.geometry.Index({11, y})] = CellState::kFree;
    estimate.states[estimate.geometry.Index({150, y})] = CellState::kOccupied;
  }
  EXPECT_FALSE(Registered(truth, estimate));
}

TEST(NearestDistances, AgreesWithBruteForce) {
  RandomStream random(5, RandomStage::kTest);
  int compared = 0;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Eigen::Vector2d> targets;
    std::vector<Eigen::Vector2d> points;
    const auto count = 1 + random.Below(40);
    for (std::uint64_t i = 0; i < count; ++i) {
      targets.emplace_back(random.Uniform(-2, 2), random.Uniform(-1, 1));
    }
    for (int i = 0; i < 50; ++i) points.emplace_back(random.Uniform(-4, 4), random.Uniform(-3, 3));
    const auto fast = NearestDistances(points, targets);
    for (std::size_t p = 0; p < points.size(); ++p, ++compared) {
      double best = INFINITY;
      for (const auto& t : targets) best = std::min(best, (t - points[p]).norm());
      ASSERT_NEAR(fast[p], best, 1e-12);  // not to the bit, as norm() may round otherwise
    }
  }
  EXPECT_EQ(compared, 2500);
}

// Points of a map that another one's origin places elsewhere.
TEST(NearestDistances, AreFoundAtOnceHoweverFarAway) {
  std::vector<Eigen::Vector2d> targets;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 3000; ++i) {
    targets.emplace_back(0.05 * i, 20.0);
    targets.emplace_back(70.0, 0.05 * i);
    points.emplace_back(0.05 * i + 1e5, 20.0);
  }
  const auto distances_m = NearestDistances(points, targets);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(distances_m[i], points[i].x() - 149.95);
  }
}

TEST(WallDistances, HandWorked) {
  const StateMap truth = DrawnMap({"#....", "#....", "#...."});
  const StateMap estimate = DrawnMap({".#...", ".#...", "...#."});
  const CellSet all = Everywhere(truth.geometry);
  const auto walls = [](const StateMap& map) { return CellsIn(map, CellState::kOccupied); };
  const WallDistanceScore score =
      ScoreWallDistances({.truth = walls(truth), .estimate = walls(estimate), .scored = all});
  EXPECT_NEAR(*score.estimate_to_truth_m, (0.05 + 0.05 + 0.15) / 3, 1e-12);
  // From below: the nearest estimated cells are 1, 1 and sqrt(2) cells away.
  EXPECT_NEAR(*score.truth_to_estimate_m, 0.05 * (2 + std::sqrt(2.0)) / 3, 1e-12);
  EXPECT_NEAR(*score.f1_5cm, 2.0 / 3.0, 1e-12);
  const double recall = 1.0, precision = 2.0 / 3.0;
  EXPECT_NEAR(*score.f1_10cm, 2 * recall * precision / (recall + precision), 1e-12);
  // Moved by one cell to the left, the upper two coincide.
  const auto moved = ScoreWallDistances(
      {.truth = walls(truth), .estimate = walls(estimate), .scored = all}, {-0.05, 0.0, 0.0});
  EXPECT_NEAR(*moved.estimate_to_truth_m, 0.1 / 3, 1e-12);
  // Lines: where walls that cross half a cell off lie on the other's, centres are half a cell away.
  const StateMap level = DrawnMap({".....", "#####", "....."});
  const auto along = DistancesToWallLines(
      {.truth = walls(level), .estimate = walls(level), .scored = all}, {0.025, 0.0, 0.0});
  EXPECT_NEAR(along->estimate_to_truth_m + along->truth_to_estimate_m, 0.025 / 5, 1e-12);
  const auto across = DistancesToWallLines(
      {.truth = walls(level), .estimate = walls(level), .scored = all}, {0.0, 0.025, 0.0});
  EXPECT_NEAR(across->estimate_to_truth_m, 0.025, 1e-12);
  EXPECT_NEAR(across->truth_to_estimate_m, 0.025, 1e-12);
  // Where only true walls are scored there is one direction, and no score of both.
  const auto one_way = ScoreWallDistances(
      {.truth = walls(truth), .estimate = walls(estimate), .scored = walls(truth)});
  EXPECT_FALSE(one_way.estimate_to_truth_m);
  EXPECT_EQ(one_way.truth_to_estimate_m, score.truth_to_estimate_m);
  EXPECT_FALSE(one_way.chamfer_m || one_way.hausdorff95_m || one_way.f1_5cm || one_way.f1_10cm);
}

}  // namespace
}  // namespace depthgrid
