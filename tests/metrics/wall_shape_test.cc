#include "eval/metrics/wall_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/metrics/drawn_map.h"

namespace depthgrid {
namespace {

CellSet DrawnWalls(const StateMap& map) { return CellsIn(map, CellState::kOccupied); }

double MeanThickness(const std::vector<std::string>& rows) {
  const StateMap map = DrawnMap(rows);
  return ThicknessOf(DrawnWalls(map), Everywhere(map.geometry))->mean_m;
}

TEST(WallThickness, HandWorked) {
  EXPECT_NEAR(MeanThickness({".....", "#####", "....."}), 0.05, 1e-12);
  EXPECT_NEAR(MeanThickness({"#....", ".#...", "..#..", "...#.", "....#"}), 0.05, 1e-12);
  // Three rows of six: along the diagonals the corners are one cell deep and the cells beside them
  // two, a cell of a diagonal being sqrt(2) long.
  const double root = std::sqrt(2.0);
  EXPECT_NEAR(MeanThickness({"......", "######", "######", "######", "......"}),
              0.05 * (4 * root + 6 * 2 * root + 8 * 3) / 18, 1e-12);
  const StateMap nothing = DrawnMap({"...."});
  EXPECT_FALSE(ThicknessOf(DrawnWalls(nothing), Everywhere(nothing.geometry)));
}

double DoubleRate(const std::vector<std::string>& truth, const std::vector<std::string>& estimate) {
  const StateMap t = DrawnMap(truth);
  return *DoubleWallRate({.truth = DrawnWalls(t),
                          .estimate = DrawnWalls(DrawnMap(estimate)),
                          .scored = Everywhere(t.geometry)});
}

TEST(DoubleWalls, HandWorked) {
  const std::vector<std::string> one = {"...#......", "...#......", "...#......", "...#......"};
  const std::vector<std::string> two = {"...#...#..", "...#...#..", "...#...#..", "...#...#.."};
  const std::vector<std::string> solid = {"...#####..", "...#####..", "...#####..", "...#####.."};
  const std::vector<std::string> both_sides = {"..#.#.....", "..#.#.....", "..#.#.....",
                                               "..#.#....."};
  EXPECT_EQ(DoubleRate(one, one), 0.0);
  EXPECT_EQ(DoubleRate(one, two), 1.0);
  EXPECT_EQ(DoubleRate(two, two), 0.0);
  EXPECT_EQ(DoubleRate(solid, two), 0.0);  // the two faces of something solid
  EXPECT_EQ(DoubleRate(one, both_sides), 1.0);
  // Beyond the reach of 0.3 m it is another wall altogether.
  EXPECT_EQ(DoubleRate({"#.........."}, {"#.......#.."}), 0.0);
  EXPECT_EQ(DoubleRate({"#.........."}, {"#.....#...."}), 1.0);
}

// The cells (x, y) of a square of `kSide` cells for which the function is true.
constexpr int kSide = 40;
template <typename IsWall>
CellSet WallsWhere(const IsWall& is_wall) {
  CellSet walls(GridGeometry{0.05, {}, kSide, kSide});
  for (std::size_t i = 0; i < walls.members.size(); ++i) {
    const Cell cell = walls.geometry.CellAt(i);
    walls.members[i] = is_wall(cell.x, cell.y) ? 1 : 0;
  }
  return walls;
}

double RateOf(const CellSet& truth, const CellSet& estimate) {
  return *DoubleWallRate(
      {.truth = truth, .estimate = estimate, .scored = Everywhere(truth.geometry)});
}

// With its two faces a wall of 10 cm has two rows of cells; they are no second wall in the room.
TEST(DoubleWalls, CountInEveryDirection) {
  for (const int shift : {3, 4, 5, 6}) {
    for (const int towards : {shift, -shift}) {
      const auto along_y = WallsWhere([](int x, int) { return x == 20 || x == 21; });
      const auto along_x = WallsWhere([](int, int y) { return y == 20 || y == 21; });
      // The face on the side of the second wall is the one that is seen.
      const int face = towards > 0 ? 21 : 20;
      const auto twice_along_y = [&](int x, int) { return x == face || x == face + towards; };
      const auto twice_along_x = [&](int, int y) { return y == face || y == face + towards; };
      EXPECT_EQ(RateOf(along_y, WallsWhere(twice_along_y)), 1.0) << towards;
      EXPECT_EQ(RateOf(along_x, WallsWhere(twice_along_x)), 1.0) << towards;
      EXPECT_EQ(RateOf(along_y, WallsWhere([&](int x, int) { return x == face; })), 0.0);
      EXPECT_EQ(RateOf(along_x, WallsWhere([&](int, int y) { return y == face; })), 0.0);
    }
  }
}

// Walls at 45 degrees, moved across by 2 cells of each axis: 4 along a row.
TEST(DoubleWalls, CountDiagonally) {
  for (const int slope : {1, -1}) {
    // Columns from the wall's middle line.
    const auto off = [&](int x, int y) { return slope > 0 ? x - y : x + y - (kSide - 1); };
    const auto wall = WallsWhere([&](int x, int y) { return off(x, y) == 0 || off(x, y) == 1; });
    const auto face = WallsWhere([&](int x, int y) { return off(x, y) == 0; });
    EXPECT_EQ(RateOf(wall, face), 0.0);
    const auto moved_back = [&](int x, int y) { return off(x, y) == 0 || off(x, y) == -4; };
    const auto moved_on = [&](int x, int y) { return off(x, y) == 1 || off(x, y) == 5; };
    const double expected = 1.0 - 4.0 / (kSide + kSide - 4);  // their ends have no second one
    EXPECT_NEAR(RateOf(wall, WallsWhere(moved_back)), expected, 0.05);
    EXPECT_NEAR(RateOf(wall, WallsWhere(moved_on)), expected, 0.05);
    // One true wall, beside which both are: it explains one of them.
    const auto beside = [&](int x, int y) { return std::abs(off(x, y)) == 1; };
    EXPECT_GT(RateOf(face, WallsWhere(beside)), 0.9);
  }
}

TEST(DoubleWalls, FacesOfThinWallsAreTwo) {
  const auto faces = WallsWhere([](int x, int) { return x == 20 || x == 22; });
  EXPECT_EQ(RateOf(faces, faces), 0.0);
  // Each a cell away from its own, on whichever side.
  for (const int left : {19, 20, 21}) {
    for (const int right : {21, 22, 23}) {
      EXPECT_EQ(RateOf(faces, WallsWhere([&](int x, int) { return x == left || x == right; })),
                0.0);
    }
  }
  const auto slanted = WallsWhere([](int x, int y) { return x - y == 0 || x - y == 3; });
  EXPECT_EQ(RateOf(slanted, slanted), 0.0);
  // Moved as a whole by a diagonal step, which is a tolerance of one cell.
  EXPECT_EQ(RateOf(slanted, WallsWhere([](int x, int y) { return x - y == 2 || x - y == 5; })),
            0.0);
  // Behind both faces a third wall that is none.
  const auto three = [](int x, int) { return x == 20 || x == 22 || x == 25; };
  EXPECT_EQ(RateOf(faces, WallsWhere(three)), 1.0);
}

// Legs of a stool, 20 cm apart, and a door's leaf that stands open before its wall.
TEST(DoubleWalls, LegsAndDoors) {
  const auto legs = [](int from, int step) {
    return WallsWhere([=](int x, int y) {
      return (x == from || x == from + step) && (y == from || y == from + step);
    });
  };
  EXPECT_EQ(RateOf(legs(10, 4), legs(10, 4)), 0.0);
  EXPECT_EQ(RateOf(legs(10, 4), legs(11, 4)), 0.0);
  EXPECT_EQ(RateOf(legs(10, 4), legs(11, 2)), 0.0);
  const auto leg = WallsWhere([](int x, int y) { return x == 10 && y == 10; });
  EXPECT_EQ(RateOf(leg, legs(10, 4)), 1.0);

  const auto door = [](int leaf_x) {
    return WallsWhere([=](int x, int y) {
      const bool is_wall = x == 10 && (y < 12 || y > 28);
      return is_wall || (x == leaf_x && y > 28 && y < 36);
    });
  };
  EXPECT_EQ(RateOf(door(14), door(14)), 0.0);
  EXPECT_EQ(RateOf(door(14), door(15)), 0.0);
  // Seven cells of a leaf that is not there and the seven of the wall behind it, of 12 + 11 + 7.
  EXPECT_NEAR(RateOf(door(10), door(14)), 14.0 / 30.0, 1e-12);
}

}  // namespace
}  // namespace depthgrid
