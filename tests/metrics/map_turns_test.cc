#include "eval/metrics/map_turns.h"

#include <gtest/gtest.h>

#include <tuple>

#include "eval/metrics/wall_distances.h"
#include "mapper/core/angle.h"
#include "tests/metrics/drawn_map.h"

namespace depthgrid {
namespace {

CellSet WallsOf(const StateMap& map) { return CellsIn(map, CellState::kOccupied); }

CellSet MirroredWalls(const StateMap& map) {
  const GridGeometry& g = map.geometry;
  GridGeometry mirrored = g;
  mirrored.min_cell.x = 7;  // anywhere
  CellSet walls(mirrored);
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    const int column = g.CellAt(i).x - g.min_cell.x;
    const Cell cell{7 + g.width_cells - 1 - column, g.CellAt(i).y};
    walls.members[mirrored.Index(cell)] = map.states[i] == CellState::kOccupied;
  }
  return walls;
}

TEST(TurnOf, SaysHowAMapIsTurnedOrMirrored) {
  const StateMap truth = MovedRoom({0.3, 0.2, 0.0});
  const CellSet all = Everywhere(truth.geometry);
  int turns = 0;
  for (const int quarters : {1, 2, 3}) {
    // Turned by so much, the map is to be turned back.
    const PlacedWalls walls{WallsOf(truth), {1.0, -2.0, WrapAngle(0.5 * kPi * quarters)}};
    const auto turn = TurnOf(truth, walls, all, 0.2);
    ASSERT_TRUE(turn) << quarters;
    EXPECT_EQ(turn->quarters, 4 - quarters);
    EXPECT_FALSE(turn->mirrored);
    ++turns;
  }
  EXPECT_EQ(turns, 3);
  const auto mirrored = TurnOf(truth, {MirroredWalls(truth), {}}, all, 0.2);
  ASSERT_TRUE(mirrored);
  EXPECT_EQ(std::tuple(mirrored->quarters, mirrored->mirrored), std::tuple(0, true));
  const auto both = TurnOf(truth, {MirroredWalls(truth), {0.0, 0.0, 0.5 * kPi}}, all, 0.2);
  ASSERT_TRUE(both);
  EXPECT_EQ(std::tuple(both->quarters, both->mirrored), std::tuple(1, true));
}

TEST(TurnOf, NothingLaysAnotherRoomOver) {
  const StateMap truth = MovedRoom({0.3, 0.2, 0.0});
  const CellSet all = Everywhere(truth.geometry);
  // And a map that lies over as it is keeps its place.
  EXPECT_FALSE(TurnOf(truth, {WallsOf(truth), {}}, all, 1.0));
  StateMap other(truth.geometry);
  for (int i = 10; i < 100; ++i) {
    other.states[other.geometry.Index({i - 20, 5})] = CellState::kOccupied;
    other.states[other.geometry.Index({i - 20, i - 20})] = CellState::kOccupied;
  }
  EXPECT_FALSE(TurnOf(truth, {WallsOf(other), {}}, all, 0.2));
}

}  // namespace
}  // namespace depthgrid
