#include "eval/metrics/map_quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval/metrics/grid_paths.h"
#include "eval/metrics/ssim.h"
#include "mapper/core/rng.h"
#include "tests/metrics/drawn_map.h"

namespace depthgrid {
namespace {

// The hill that registration climbs is not what scores count.
TEST(MapQuality, AMotionThatMakesBothScoresWorseIsNoErrorOfTheMap) {
  const auto fits_better = [](double chamfer_m, double f1_5cm) {
    MapQuality quality;
    quality.walls.chamfer_m = 0.0141;
    quality.walls.f1_5cm = 0.9865;
    WallDistanceScore& moved = quality.registered.emplace();
    moved.chamfer_m = chamfer_m;
    moved.f1_5cm = f1_5cm;
    return FitsBetterAsItLies(quality);
  };
  EXPECT_TRUE(fits_better(0.0187, 0.9601));
  EXPECT_FALSE(fits_better(0.0187, 0.9865));
  EXPECT_FALSE(fits_better(0.0101, 0.9601));
  EXPECT_FALSE(fits_better(0.0141, 0.9865));
  EXPECT_FALSE(FitsBetterAsItLies(MapQuality{}));
}

TEST(Calibration, HandWorked) {
  const StateMap truth = DrawnMap({"##..?"});
  OccupancyMap estimate(truth.geometry);
  estimate.occupied_prob = {0.95F, 0.6F, 0.2F, kUnknownProb, 0.9F};
  const auto c = Calibrate(truth, estimate, Everywhere(truth.geometry));
  ASSERT_TRUE(c);
  EXPECT_EQ(c->cells, 3);  // neither the cell never seen nor the one whose truth is unknown
  EXPECT_NEAR(c->brier, (0.0025 + 0.16 + 0.04) / 3, 1e-7);
  EXPECT_NEAR(c->log_loss, -(std::log(0.95) + std::log(0.6) + std::log(0.8)) / 3, 1e-6);
  EXPECT_NEAR(c->calibration_error, (0.05 + 0.4 + 0.2) / 3, 1e-7);
  EXPECT_EQ(c->bins[9].cells, 1);
  EXPECT_NEAR(c->bins[9].mean_prob, 0.95, 1e-6);
  EXPECT_EQ(c->bins[9].occupied_share, 1.0);
  // One sure error costs -ln(0.001), not infinity.
  estimate.occupied_prob = {0.0F, 1.0F, 0.0F, 0.0F, 0.0F};
  EXPECT_NEAR(Calibrate(truth, estimate, Everywhere(truth.geometry))->log_loss,
              (-std::log(0.001) - 3 * std::log(0.999)) / 4, 1e-12);
}

TEST(Calibration, TrueProbabilitiesAreCalibrated) {
  RandomStream random(6, RandomStage::kTest);
  StateMap truth(GridGeometry{0.05, {}, 300, 300});
  OccupancyMap estimate(truth.geometry);
  for (std::size_t i = 0; i < truth.states.size(); ++i) {
    const double prob = random.Uniform();
    estimate.occupied_prob[i] = static_cast<float>(prob);
    truth.states[i] = random.Uniform() < prob ? CellState::kOccupied : CellState::kFree;
  }
  const auto c = Calibrate(truth, estimate, Everywhere(truth.geometry));
  EXPECT_LT(c->calibration_error, 0.01);    // 9,000 cells a bin: 3 standard errors
  EXPECT_NEAR(c->brier, 1.0 / 6.0, 0.002);  // the integral of p (1 - p)
  EXPECT_NEAR(c->log_loss, 0.5, 0.004);     // the integral of -p ln p - (1 - p) ln (1 - p)
}

// NumPy 1.24.2, SciPy 1.10.1, on x = ((i * 7 + j * 3) % 3) / 2, y = ((i * 5 + j * 2 + i * j % 4) %
// 3) / 2 (row i of 14 from the smallest y, column j of 17), padded with 0.5 by 5:
//   f = lambda a: gaussian_filter(a, 1.5, truncate=3.5, mode='nearest')
//   mx, my = f(P), f(Q); sx = f(P*P) - mx*mx; sy = f(Q*Q) - my*my; sxy = f(P*Q) - mx*my
//   S = ((2*mx*my+1e-4)*(2*sxy+9e-4)) / ((mx*mx+my*my+1e-4)*(sx+sy+9e-4)); S[5:-5,5:-5].mean()
TEST(Ssim, AgreesWithNumPy) {
  constexpr std::array<CellState, 3> kStates = {CellState::kFree, CellState::kUnknown,
                                                CellState::kOccupied};
  StateMap x(GridGeometry{0.05, {}, 17, 14});
  StateMap y(x.geometry);
  for (int i = 0; i < 14; ++i) {
    for (int j = 0; j < 17; ++j) {
      const std::size_t at = x.geometry.Index({j, i});
      x.states[at] = kStates[static_cast<std::size_t>((i * 7 + j * 3) % 3)];
      y.states[at] = kStates[static_cast<std::size_t>((i * 5 + j * 2 + (i * j) % 4) % 3)];
    }
  }
  EXPECT_NEAR(*Ssim(x, y, Everywhere(x.geometry)), 0.006366052798117391, 1e-12);
  EXPECT_NEAR(*Ssim(x, x, Everywhere(x.geometry)), 1.0, 1e-12);
  EXPECT_FALSE(Ssim(x, y, CellSet(x.geometry)));
}

TEST(Truthless, CountsCornersAndAreas) {
  std::vector<std::string> rows(30, std::string(40, '.'));
  EXPECT_EQ(ScoreWithoutTruth(DrawnMap(rows)).corners, 0);
  for (auto& row : rows) row[10] = '#';  // a wall from edge to edge
  const TruthlessScore wall = ScoreWithoutTruth(DrawnMap(rows));
  EXPECT_EQ(wall.corners, 2);  // its ends
  EXPECT_EQ(wall.enclosed_areas, 0);
  EXPECT_NEAR(*wall.occupied_share, 30.0 / 1200.0, 1e-12);
  for (auto& row : rows) row[11] = '#';  // as thick as two cells, both of which end alike
  EXPECT_EQ(ScoreWithoutTruth(DrawnMap(rows)).corners, 2);
  std::vector<std::string> box(30, std::string(40, '?'));
  for (std::size_t x = 8; x <= 30; ++x) box[5][x] = box[22][x] = '#';
  for (std::size_t y = 5; y <= 22; ++y) box[y][8] = box[y][30] = '#';
  EXPECT_EQ(ScoreWithoutTruth(DrawnMap(box)).corners, 4);
  EXPECT_EQ(ScoreWithoutTruth(DrawnMap(box)).enclosed_areas, 1);
  for (std::size_t x = 8; x <= 30; ++x) box[15][x] = '#';  // divided: two rooms, two junctions more
  EXPECT_EQ(ScoreWithoutTruth(DrawnMap(box)).corners, 6);
  EXPECT_EQ(ScoreWithoutTruth(DrawnMap(box)).enclosed_areas, 2);
  box[15][20] = '?';  // a gap joins them
  EXPECT_EQ(ScoreWithoutTruth(DrawnMap(box)).enclosed_areas, 1);
}

TEST(GridPaths, ShortestWayRoundAWall) {
  const StateMap map = DrawnMap({".....", ".###.", "....."});
  const GridPaths ways(CellsIn(map, CellState::kFree), {2, 0});
  // Diagonals that would cut the wall's corner are not taken: two steps right, two up, two left.
  EXPECT_NEAR(*ways.LengthCells({2, 2}), 6.0, 1e-6);
  EXPECT_EQ(ways.PathTo({2, 2}).size(), 7U);
  EXPECT_EQ(ways.PathTo({2, 2}).front(), (Cell{2, 0}));
  EXPECT_EQ(ways.PathTo({2, 2}).back(), (Cell{2, 2}));
  EXPECT_FALSE(ways.LengthCells({2, 1}));
  EXPECT_TRUE(ways.PathTo({2, 1}).empty());
  const GridPaths open(Everywhere(map.geometry), {0, 0});
  EXPECT_NEAR(*open.LengthCells({4, 2}), 2.0 + 2.0 * std::sqrt(2.0), 1e-5);
  EXPECT_FALSE(GridPaths(CellsIn(map, CellState::kFree), {2, 1}).LengthCells({0, 0}));
}

// Two rooms joined by a door of `door_cells` free cells.
StateMap TwoRooms(int door_cells) {
  std::vector<std::string> rows(40, std::string(80, '.'));
  for (auto& row : rows) row.front() = row.back() = row[40] = '#';
  rows.front() = rows.back() = std::string(80, '#');
  const int first = (40 - door_cells) / 2;
  for (int i = 0; i < door_cells; ++i) rows[static_cast<std::size_t>(first + i)][40] = '.';
  return DrawnMap(rows);
}

TEST(Navigability, APerfectMapIsDrivenPerfectly) {
  const StateMap map = TwoRooms(10);
  const auto score = Navigate(map, map, Everywhere(map.geometry), {});
  ASSERT_TRUE(score);
  EXPECT_EQ(score->pairs, 40);
  EXPECT_EQ(score->success_rate, 1.0);
  EXPECT_EQ(score->falsely_blocked_rate, 0.0);
  EXPECT_EQ(*score->collision_rate, 0.0);
  EXPECT_EQ(*score->length_ratio, 1.0);
}

// A corridor of seven cells: its middle is three cells from both walls, 0.15 m of centres. In
// doubles (0.10 + 0.05) / 0.05 is more than 3.
TEST(Navigability, ARobotFitsWhereItsRadiusAndMarginAreWholeCells) {
  std::vector<std::string> rows(5, std::string(60, '.'));
  rows.insert(rows.begin(), std::string(60, '#'));
  rows.push_back(std::string(60, '#'));
  const StateMap map = DrawnMap(rows);
  NavigabilityOptions robot;
  robot.robot_radius_m = 0.10;
  EXPECT_TRUE(Navigate(map, map, Everywhere(map.geometry), robot));
  robot.robot_radius_m = 0.11;
  EXPECT_FALSE(Navigate(map, map, Everywhere(map.geometry), robot));
}

// In two cells each start has one goal, which is not itself.
TEST(Navigability, AGoalIsNeverTheStart) {
  const StateMap map = DrawnMap({"####", "#..#", "####"});
  NavigabilityOptions robot;
  robot.robot_radius_m = robot.margin_m = robot.least_distance_m = 0.0;
  const auto score = Navigate(map, map, Everywhere(map.geometry), robot);
  ASSERT_TRUE(score);
  EXPECT_EQ(score->pairs, 40);
  EXPECT_EQ(*score->length_ratio, 1.0);
  const StateMap one = DrawnMap({"###", "#.#", "###"});
  EXPECT_FALSE(Navigate(one, one, Everywhere(one.geometry), robot));
}

TEST(Navigability, WallsThatAreNotThereBlockAndMissingOnesCollide) {
  const StateMap with_door = TwoRooms(10);
  const StateMap without = TwoRooms(0);
  const StateMap open = TwoRooms(38);
  const CellSet all = Everywhere(with_door.geometry);
  const auto blocked = Navigate(with_door, without, all, {});
  EXPECT_GT(blocked->falsely_blocked_rate, 0.2);  // errands into the other room
  EXPECT_LT(blocked->falsely_blocked_rate, 0.9);
  EXPECT_EQ(*blocked->collision_rate, 0.0);
  EXPECT_EQ(*blocked->length_ratio, 1.0);
  const auto through_wall = Navigate(with_door, open, all, {});
  EXPECT_EQ(through_wall->falsely_blocked_rate, 0.0);
  EXPECT_GT(*through_wall->collision_rate, 0.1);
  EXPECT_LT(*through_wall->length_ratio, 1.0);
  EXPECT_NEAR(through_wall->success_rate, 1.0 - *through_wall->collision_rate, 1e-12);
  // Where the truth has no way, nothing is asked.
  EXPECT_EQ(Navigate(without, with_door, all, {})->falsely_blocked_rate, 0.0);
  EXPECT_FALSE(Navigate(StateMap(all.geometry), with_door, all, {}));
}

// The map has the door one cell off, so that plans go through it a cell nearer to the true wall
// than the margin: that is what the margin is for.
TEST(Navigability, AWayThatOnlyTheMarginLeavesIsNoCollision) {
  const auto rooms = [](std::size_t door_row) {
    std::vector<std::string> rows(60, std::string(60, '.'));
    for (std::size_t x = 0; x < 60; ++x) rows.front()[x] = rows.back()[x] = '#';
    for (std::size_t y = 0; y < 60; ++y) {
      rows[y].front() = rows[y].back() = '#';
      if (y < door_row || y >= door_row + 12) rows[y][30] = '#';
    }
    return DrawnMap(rows);
  };
  NavigabilityOptions robot;
  robot.robot_radius_m = 0.1;
  robot.margin_m = 0.05;
  const StateMap truth = rooms(20);
  const auto score = Navigate(truth, rooms(21), Everywhere(truth.geometry), robot);
  ASSERT_TRUE(score);
  ASSERT_GT(score->planned, 20);
  EXPECT_EQ(*score->collision_rate, 0.0);
}

TEST(Navigability, ADoorDrawnTooNarrowBlocksAWideRobot) {
  const StateMap narrow = TwoRooms(8);
  const StateMap wide = TwoRooms(14);
  const CellSet all = Everywhere(narrow.geometry);
  NavigabilityOptions robot;
  EXPECT_EQ(Navigate(wide, narrow, all, robot)->falsely_blocked_rate, 0.0);
  robot.robot_radius_m = 0.2;  // with the margin it needs ten cells
  const auto blocked = Navigate(wide, narrow, all, robot);
  EXPECT_GT(blocked->falsely_blocked_rate, 0.2);
  robot.seed = 2;
  EXPECT_NE(Navigate(wide, narrow, all, robot)->falsely_blocked_rate,
            blocked->falsely_blocked_rate);
}

// Walls on the lattice's lines: the truth has each in the cell above, a good map some cells of it
// below. All of the map may be off by a part of a cell, but no motion brings the walls nearer.
TEST(MapQuality, WallsOnCellBoundariesAreNoShift) {
  const StateMap truth = MovedRoom({1e-4, 1e-4, 0.0});
  const StateMap below = MovedRoom({-1e-4, -1e-4, 0.0});
  StateMap states = truth;
  for (std::size_t i = 0; i < states.states.size(); ++i) {
    const Cell cell = truth.geometry.CellAt(i);
    if ((cell.x / 3 + cell.y / 3) % 5 < 2) states.states[i] = below.states[i];
  }
  const CellSet all = Everywhere(truth.geometry);
  ASSERT_GT(RegisterMap(truth, states, all)->mean_shift_m, 0.01);
  const auto quality_of = [&](const StateMap& estimate) {
    OccupancyMap map(estimate.geometry);
    for (std::size_t i = 0; i < estimate.states.size(); ++i) {
      if (estimate.states[i] == CellState::kOccupied) map.occupied_prob[i] = 0.9F;
      if (estimate.states[i] == CellState::kFree) map.occupied_prob[i] = 0.1F;
    }
    return ScoreMapQuality(truth, map, std::nullopt, {});
  };
  const MapQuality lies_right = quality_of(states);
  EXPECT_EQ(lies_right.registration->truth_from_estimate, Pose2{});
  EXPECT_EQ(lies_right.registration->mean_shift_m, 0.0);
  EXPECT_EQ(lies_right.registered->chamfer_m, lies_right.walls.chamfer_m);
  const MapQuality shifted = quality_of(MovedRoom({0.08, -0.06, 0.0}));
  EXPECT_NEAR(shifted.registration->mean_shift_m, 0.1, 0.02);
  EXPECT_LT(*shifted.registered->chamfer_m, *shifted.walls.chamfer_m);
}

TEST(MapQuality, APerfectMap) {
  const StateMap truth = MovedRoom({0.013, 0.021, 0.05});
  OccupancyMap estimate(truth.geometry);
  for (std::size_t i = 0; i < truth.states.size(); ++i) {
    if (truth.states[i] == CellState::kOccupied) estimate.occupied_prob[i] = 0.9F;
    if (truth.states[i] == CellState::kFree) estimate.occupied_prob[i] = 0.1F;
  }
  const MapQuality q = ScoreMapQuality(truth, estimate, std::nullopt, {});
  EXPECT_EQ(*q.walls.f1_5cm, 1.0);
  EXPECT_EQ(*q.walls.chamfer_m, 0.0);
  EXPECT_NEAR(*q.registered->chamfer_m, 0.0, 1e-3);
  EXPECT_EQ(q.thickness->mean_m, q.true_thickness->mean_m);
  EXPECT_EQ(*q.double_wall_rate, 0.0);
  EXPECT_NEAR(*q.ssim, 1.0, 1e-12);
  EXPECT_NEAR(q.calibration->brier, 0.01, 1e-6);
  EXPECT_EQ(q.truthless.corners, q.truthless_of_truth.corners);
  EXPECT_EQ(q.navigability->success_rate, 1.0);
  MetricsOptions few;
  few.registration = few.ssim = few.navigation = false;
  const MapQuality cheap = ScoreMapQuality(truth, estimate, std::nullopt, few);
  EXPECT_FALSE(cheap.registration || cheap.registered || cheap.ssim || cheap.navigability);
  // Nothing at all estimated.
  const MapQuality none = ScoreMapQuality(truth, OccupancyMap(truth.geometry), std::nullopt, {});
  EXPECT_FALSE(none.registration || none.thickness || none.calibration || none.walls.chamfer_m);
  EXPECT_EQ(none.navigability->success_rate, 0.0);
}

}  // namespace
}  // namespace depthgrid
