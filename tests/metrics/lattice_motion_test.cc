// A map's file may lay it anywhere: wherever it does, the same registration is to come out.
#include "eval/metrics/lattice_motion.h"

#include <gtest/gtest.h>

#include <string>

#include "eval/metrics/map_quality.h"
#include "mapper/core/rng.h"
#include "tests/metrics/drawn_map.h"
#include "tests/metrics/metric_curves.h"

namespace depthgrid {
namespace {

CellSet WallCells(const StateMap& map) { return CellsIn(map, CellState::kOccupied); }

TEST(LieAlongLattice, HandWorked) {
  EXPECT_TRUE(LieAlongLattice(WallCells(DrawnMap({"#####", "#....", "#....", "#...."}))));
  EXPECT_TRUE(LieAlongLattice(WallCells(DrawnMap({"#######", "#######"}))));
  // Steps: of walls nearly along the rows or the columns, and across.
  EXPECT_FALSE(LieAlongLattice(WallCells(DrawnMap({"####......", "....######"}))));
  EXPECT_FALSE(LieAlongLattice(WallCells(DrawnMap({".#", ".#", ".#", "#.", "#.", "#."}))));
  EXPECT_FALSE(LieAlongLattice(WallCells(DrawnMap({"...##", ".##..", "#...."}))));
  EXPECT_FALSE(LieAlongLattice(WallCells(DrawnMap({"...."}))));
}

TEST(LieAlongLattice, RoomsTurnedByTwoDegreesDoNot) {
  EXPECT_TRUE(LieAlongLattice(WallCells(MovedRoom({0.013, 0.021, 0.0}))));
  for (const double yaw_rad : {0.035, -0.05, 0.1, 0.3}) {
    EXPECT_FALSE(LieAlongLattice(WallCells(MovedRoom({0.513, 0.521, yaw_rad})))) << yaw_rad;
  }
}

TEST(OntoLattice, TakesTheCellsThatFitAndKeepsQuarterTurns) {
  const CellSet walls = WallCells(DrawnMap({"#...", "#...", "####"}));
  const std::vector<Eigen::Vector2d> centres_m = CentresOf(walls);
  const Pose2 there = OntoLattice(walls, centres_m, {0.04, -0.03, 0.02});
  EXPECT_NEAR(there.x_m, 0.0, 1e-12);
  EXPECT_NEAR(there.y_m, 0.0, 1e-12);
  EXPECT_EQ(there.yaw_rad, 0.0);
  const Pose2 turned{0.2, 0.0, 0.5 * kPi};
  std::vector<Eigen::Vector2d> back_m;
  for (const Eigen::Vector2d& p : centres_m) back_m.push_back(Inverse(turned) * p);
  const Pose2 found = OntoLattice(walls, back_m, turned);
  for (std::size_t i = 0; i < back_m.size(); ++i) {
    EXPECT_NEAR((found * back_m[i] - centres_m[i]).norm(), 0.0, 1e-12);
  }
}

// Of a fifth of the wall cells the one to the left is wall too, and a fifth is not found.
StateMap Noisy(const StateMap& room) {
  RandomStream random(8, RandomStage::kTest);
  StateMap noisy = room;
  for (std::size_t i = 1; i < room.states.size(); ++i) {
    if (room.states[i] != CellState::kOccupied) continue;
    const double drawn = random.Uniform();
    if (drawn < 0.2) noisy.states[i - 1] = CellState::kOccupied;
    if (drawn > 0.8) noisy.states[i] = CellState::kFree;
  }
  return noisy;
}

MapQuality QualityAt(const StateMap& truth, const StateMap& estimate, const Pose2& wrong) {
  MetricsOptions options;
  options.ssim = options.navigation = false;
  return ScoreMapQuality(truth, SureMap(estimate), std::nullopt, options,
                         PlacedWalls{WallCells(estimate), wrong});
}

// Shifts from nothing to 0.3 m, with and without a turn, of rooms along the lattice and across it,
// against themselves and with noise: what is left is what is left of the map that was not moved.
TEST(MapQuality, EveryShiftIsFound) {
  constexpr double kCellM = 0.05;
  int found_motions = 0;
  for (const double room_yaw_rad : {0.0, 0.3}) {
    const StateMap truth = MovedRoom({0.513, 0.521, room_yaw_rad});
    for (const StateMap& estimate : {truth, Noisy(truth)}) {
      const MapQuality unmoved = QualityAt(truth, estimate, {});
      const Pose2 least = unmoved.registration->truth_from_estimate;
      const Eigen::Vector2d middle(2.0, 2.0);
      EXPECT_LT((least * middle - middle).norm(), 0.006);
      for (const double cells : {0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 1.1, 1.5, 6.0}) {
        for (const Eigen::Vector2d& way : {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0),
                                           Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 1)}) {
          for (const double yaw_rad : {0.0, 0.03}) {
            const Eigen::Vector2d shift = cells * kCellM * way;
            const Pose2 wrong{shift.x(), shift.y(), yaw_rad};
            const MapQuality moved = QualityAt(truth, estimate, wrong);
            const Pose2 left = moved.registration->truth_from_estimate * wrong;
            const std::string where = std::to_string(cells) + " cells along " +
                                      std::to_string(way.x()) + " " + std::to_string(way.y()) +
                                      ", yaw " + std::to_string(yaw_rad);
            EXPECT_LT((left * middle - least * middle).norm(), 0.001) << where;
            EXPECT_NEAR(left.yaw_rad, least.yaw_rad, 0.001) << where;
            EXPECT_NEAR(*moved.registered->chamfer_m, *unmoved.registered->chamfer_m, 0.001)
                << where;
            ++found_motions;
          }
        }
      }
    }
  }
  EXPECT_EQ(found_motions, 288);
}

// Walls along the true lattice leave shifts open within a cell, but not a turn that moves their
// ends by more.
TEST(MapQuality, ATurnOfARoomAlongTheLatticeIsFound) {
  const Pose2 room{0.313, 0.521, 0.0};
  const Pose2 middle{2.3, 2.0, 0.0};
  for (const double shift_m : {0.0, 0.02, 0.11}) {
    const Pose2 wrong =
        Pose2{shift_m, 0.0, 0.0} * middle * Pose2{0.0, 0.0, 0.035} * Inverse(middle);
    const MapQuality moved = QualityAt(MovedRoom(room), MovedRoom(wrong * room), {});
    EXPECT_NEAR(moved.registration->truth_from_estimate.yaw_rad, -0.035, 0.005) << shift_m;
  }
}

}  // namespace
}  // namespace depthgrid
