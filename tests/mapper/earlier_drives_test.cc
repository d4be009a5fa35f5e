// What was moved between two drives through one place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/drives.h"
#include "mapper/grid/map_drawing.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;

TEST(EarlierDrives, HaveNumbersWithOneLeftOutBetweenThem) {
  EXPECT_THAT(PriorNumbers({}), ElementsAre());
  // Of a first drive frames are left out, as they are not kept.
  EXPECT_THAT(PriorNumbers({0, 4, 5}), ElementsAre(-3, -2, -1));
  const std::vector<int> second = PriorNumbers({-3, -2, -1, 0, 7});
  EXPECT_THAT(second, ElementsAre(-6, -5, -4, -2, -1));
  const std::vector<int> third = PriorNumbers({-6, -5, -4, -2, -1, 3, 4});
  EXPECT_THAT(third, ElementsAre(-9, -8, -7, -5, -4, -2, -1));
  int drives = 1;
  for (std::size_t i = 1; i < third.size(); ++i) drives += BeginsDrive(third[i - 1], third[i]);
  EXPECT_EQ(drives, 3);
  EXPECT_TRUE(BeginsDrive(-1, 0));
  EXPECT_FALSE(BeginsDrive(0, 4));
}

void Drive(const PlanarWorld& world, int scans, std::uint32_t first, MapDrawing& drawing) {
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(scans); ++i) {
    drawing.Add(ScanOf(world, {}, {.sigma_of_range = 0.005}, 3, first + i), {});
  }
}

struct Cells {
  CellState gone, come, wall, hidden;
};

// 500 scans of a box, then 100 in which it stands elsewhere.
Cells AfterTwoDrives(int earlier_scans) {
  PlanarWorld before = {{{5.025, -3.0}, {5.025, 3.0}}};
  PlanarWorld after = before;
  before.push_back({{2.025, -0.5}, {2.025, 0.5}});
  after.push_back({{3.025, 0.8}, {3.025, 1.8}});
  GridOptions options;
  options.earlier_scans = earlier_scans;
  MapDrawing drawing(options);
  Drive(before, 500, 0, drawing);
  drawing.BeginDrive();
  Drive(after, 100, 1000, drawing);
  const StateMap states = StatesOf(drawing.Map());
  // The wall in view of both, and where the box now hides it.
  return {states.At({40, 0}), states.At({60, 24}), states.At({100, -30}), states.At({100, 42})};
}

TEST(EarlierDrives, WhatWasMovedComesAndGoes) {
  const Cells cells = AfterTwoDrives(GridOptions{}.earlier_scans);
  EXPECT_EQ(cells.gone, CellState::kFree);
  EXPECT_EQ(cells.come, CellState::kOccupied);
  EXPECT_EQ(cells.wall, CellState::kOccupied);
  EXPECT_EQ(cells.hidden, CellState::kOccupied);
  const Cells all_alike = AfterTwoDrives(0);
  EXPECT_EQ(all_alike.gone, CellState::kOccupied);
  EXPECT_NE(all_alike.come, CellState::kOccupied);
}

// Drawn drive by drive as with all drives but the last taken together first.
TEST(EarlierDrives, MayBeMany) {
  const PlanarWorld wall = {{{4.025, -3.0}, {4.025, 3.0}}};
  MapDrawing drawing{GridOptions{}};
  for (std::uint32_t drive = 0; drive < 4; ++drive) {
    if (drive > 0) drawing.BeginDrive();
    Drive(drive == 2 ? PlanarWorld{{{5.025, -3.0}, {5.025, 3.0}}} : wall, 100, 100 * drive,
          drawing);
  }
  const StateMap states = StatesOf(drawing.Map());
  EXPECT_EQ(states.At({80, 0}), CellState::kOccupied);  // it is back
  drawing.BeginDrive();
  EXPECT_EQ(StatesOf(drawing.Map()).states, states.states);  // nothing seen anew
}

}  // namespace
}  // namespace depthgrid
