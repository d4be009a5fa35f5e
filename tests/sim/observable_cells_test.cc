#include "sim/truth/observable_cells.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/level.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

// A room of 8 x 6 m with its walls inside cells, not on their boundaries.
TriangleMesh Room() { return test::Box({0.02F, 0.02F, 0}, {8.02F, 6.02F, 2.5F}); }

Trajectory At(double x_m, double y_m, double yaw_deg, double height_m = 1.15) {
  return {{0.0, CameraOf({x_m, y_m, RadFromDeg(yaw_deg)}, height_m)}};
}

struct World {
  StateMap truth;
  CellSet seen;

  bool Sees(double x_m, double y_m) const { return seen.Has(CellOf({x_m, y_m}, 0.05)); }
  CellState StateAt(double x_m, double y_m) const { return truth.At(CellOf({x_m, y_m}, 0.05)); }
};

World Look(const TriangleMesh& mesh, const Trajectory& path, const ObservableOptions& options = {},
           const PinholeCamera& camera = {}) {
  const TruthGridOptions grid;
  World world{TruthMap(mesh, 0.0, path, grid), {}};
  world.seen = ObservableCells(mesh, 0.0, world.truth, camera, path, grid, options);
  return world;
}

TEST(ObservableCells, OfAnEmptyRoomByHand) {
  const World world = Look(Room(), At(4.0, 3.0, 0.0));
  // The wall ahead is 4.02 m away; ICL's field of view reaches tan = 0.664 to the left.
  EXPECT_TRUE(world.Sees(8.03, 3.0));
  EXPECT_TRUE(world.Sees(8.03, 3.0 + 4.02 * 0.64));
  EXPECT_FALSE(world.Sees(8.03, 3.0 + 4.02 * 0.69));
  EXPECT_FALSE(world.Sees(0.03, 3.0));  // behind
  EXPECT_FALSE(world.Sees(3.0, 3.0));
  // Free cells: not before the lowest ray, 0.125 m above the floor, comes into view: 1.025 m down
  // at a slope of 240 / 480 is 2.05 m away.
  EXPECT_EQ(world.StateAt(5.9, 3.0), CellState::kFree);
  EXPECT_FALSE(world.Sees(5.9, 3.0));
  EXPECT_TRUE(world.Sees(6.2, 3.0));
  EXPECT_TRUE(world.Sees(7.99, 3.0));
}

TEST(ObservableCells, RangeLimits) {
  ObservableOptions near;
  near.max_range_m = 3.0;
  const World world = Look(Room(), At(4.0, 3.0, 0.0), near);
  EXPECT_FALSE(world.Sees(8.03, 3.0));
  EXPECT_TRUE(world.Sees(6.9, 3.0));
  EXPECT_FALSE(world.Sees(7.1, 3.0));
  // 0.38 m before the wall, which is nearer than the least range.
  EXPECT_FALSE(Look(Room(), At(7.64, 3.0, 0.0)).Sees(8.03, 3.0));
  EXPECT_TRUE(Look(Room(), At(7.54, 3.0, 0.0)).Sees(8.03, 3.0));
}

TEST(ObservableCells, SensorsDepthLimits) {
  // 3 m of depth is a plane across the view, not a circle: aside, it is further away.
  ObservableOptions sensor;
  sensor.max_depth_m = 3.0;
  const World world = Look(Room(), At(4.0, 3.0, 0.0), sensor);
  EXPECT_TRUE(world.Sees(6.9, 3.0));
  EXPECT_TRUE(world.Sees(6.9, 3.0 + 2.9 * 0.6));
  EXPECT_FALSE(world.Sees(7.1, 3.0));
  EXPECT_FALSE(world.Sees(8.03, 3.0));
  sensor.min_depth_m = 2.5;
  EXPECT_FALSE(Look(Room(), At(4.0, 3.0, 0.0), sensor).Sees(6.3, 3.0));
}

TEST(ObservableCells, NothingBehindAnObstacleOfTheBand) {
  TriangleMesh mesh = Room();
  Append(mesh, test::Box({6.51F, 2.76F, 0}, {6.74F, 3.24F, 2.5F}));  // a pillar
  const World world = Look(mesh, At(4.0, 3.0, 0.0));
  EXPECT_TRUE(world.Sees(6.52, 3.0));
  EXPECT_EQ(world.StateAt(6.73, 3.0), CellState::kOccupied);
  EXPECT_FALSE(world.Sees(6.73, 3.0));
  EXPECT_FALSE(world.Sees(7.5, 3.0));
  EXPECT_FALSE(world.Sees(8.03, 3.0));
  EXPECT_TRUE(world.Sees(8.03, 3.0 + 4.02 * 0.3));
}

TEST(ObservableCells, LowFurnitureHidesWhatIsBehindItInTheBand) {
  TriangleMesh mesh = Room();
  Append(mesh, test::Box({6.51F, 2.0F, 0}, {7.0F, 4.0F, 0.45F}));
  const World world = Look(mesh, At(4.0, 3.0, 0.0));
  EXPECT_TRUE(world.Sees(6.52, 3.0));
  EXPECT_FALSE(world.Sees(7.5, 3.0));
  EXPECT_FALSE(world.Sees(8.03, 3.0));
  // From 1 m before it, its front is below the view and cannot be told.
  EXPECT_FALSE(Look(mesh, At(5.5, 3.0, 0.0)).Sees(6.52, 3.0));
  // Below the band it hides nothing.
  TriangleMesh flat = Room();
  Append(flat, test::Box({6.51F, 2.0F, 0}, {7.0F, 4.0F, 0.09F}));
  EXPECT_TRUE(Look(flat, At(4.0, 3.0, 0.0)).Sees(8.03, 3.0));
}

TEST(ObservableCells, HangingThingsBlockToo) {
  TriangleMesh mesh = Room();
  Append(mesh, test::Box({6.51F, 2.0F, 1.3F}, {6.76F, 4.0F, 1.6F}));
  const World world = Look(mesh, At(4.0, 3.0, 0.0));
  EXPECT_TRUE(world.Sees(6.52, 3.0));
  EXPECT_FALSE(world.Sees(8.03, 3.0));
}

TEST(ObservableCells, ThinBoardsBlockToo) {
  // A table top 2 mm thick on nothing, and a shelf of one triangle's thickness.
  for (const float thickness_m : {0.002F, 0.0F}) {
    TriangleMesh mesh = Room();
    Append(mesh, test::Box({6.51F, 2.0F, 0.703F}, {7.0F, 4.0F, 0.703F + thickness_m}));
    const World world = Look(mesh, At(4.0, 3.0, 0.0));
    EXPECT_EQ(world.StateAt(6.72, 3.0), CellState::kOccupied);
    EXPECT_TRUE(world.Sees(6.52, 3.0));
    EXPECT_FALSE(world.Sees(6.72, 3.0));
    EXPECT_FALSE(world.Sees(7.5, 3.0));
    EXPECT_FALSE(world.Sees(8.03, 3.0));
  }
}

TEST(ObservableCells, WallsOnCellBoundariesAreSeenFromBothSides) {
  // Walls at 0 and 8 m lie on boundaries; the hit may come out on either side of them.
  const TriangleMesh mesh = test::Box({0, 0, 0}, {8, 6, 2.5F});
  int seen = 0;
  for (const double yaw_deg : {0.0, 90.0, 180.0, 270.0}) {
    const World world = Look(mesh, At(4.0, 3.0, yaw_deg));
    for (int k = -20; k <= 20; ++k) {
      const double side_m = 0.05 * k + 0.025;
      const double c = std::round(std::cos(RadFromDeg(yaw_deg)));
      const double s = std::round(std::sin(RadFromDeg(yaw_deg)));
      // The cell above the boundary, in the floor convention.
      const double x = 4.0 + c * 4.0 + (c != 0 ? 0.025 : side_m);
      const double y = 3.0 + s * 3.0 + (s != 0 ? 0.025 : side_m);
      EXPECT_EQ(world.StateAt(x, y), CellState::kOccupied);
      EXPECT_TRUE(world.Sees(x, y)) << yaw_deg << " " << k;
      seen += world.Sees(x, y) ? 1 : 0;
    }
  }
  EXPECT_EQ(seen, 4 * 41);
}

TEST(ObservableCells, ATurnedAndTiltedCameraSeesAccordingly) {
  // Looking 40 degrees down from 1.15 m, the view ends 13.4 degrees below the horizon: the band's
  // lower limit leaves it at 1.05 / tan(13.4 deg) = 4.4 m, so the wall 4.02 m ahead is seen just
  // above the floor; 50 degrees down it is not.
  const auto tilted = [](double down_deg) {
    Trajectory path = At(4.0, 3.0, 0.0);
    path[0].world_from_camera.rotation =
        path[0].world_from_camera.rotation *
        Eigen::AngleAxisd(RadFromDeg(-down_deg), Eigen::Vector3d::UnitX());
    return path;
  };
  const World down = Look(Room(), tilted(40.0));
  EXPECT_TRUE(down.Sees(8.03, 3.0));
  EXPECT_TRUE(down.Sees(4.7, 3.0));  // the floor is in view from 0.5 m on
  const World further_down = Look(Room(), tilted(50.0));
  EXPECT_FALSE(further_down.Sees(8.03, 3.0));
  // Straight down every bearing is in view, as far as the pyramid reaches: 0.66 x 1.05 m sideways.
  const World straight = Look(Room(), tilted(90.0));
  EXPECT_TRUE(straight.Sees(4.0, 3.55));
  EXPECT_TRUE(straight.Sees(4.0, 2.45));
  EXPECT_FALSE(straight.Sees(4.0, 3.85));
  // Straight up nothing of the lowest height is.
  const World up = Look(Room(), tilted(-90.0));
  EXPECT_EQ(std::count(up.seen.members.begin(), up.seen.members.end(), 1), 0);
}

TEST(ObservableCells, ThreadsDoNotChangeTheSet) {
  const TriangleMesh mesh = test::ClutteredRoom(2000);
  Trajectory path;
  for (int i = 0; i < 23; ++i) {
    path.push_back({i / 30.0, CameraOf({2.0, 2.0 + 0.02 * i, 0.2 * i}, 1.15)});
  }
  const CellSet serial = Look(mesh, path).seen;
  EXPECT_GT(std::count(serial.members.begin(), serial.members.end(), 1), 1000);
  for (const int threads : {2, 3}) {
    ObservableOptions options;
    options.threads = threads;
    EXPECT_EQ(Look(mesh, path, options).seen, serial);
  }
}

TEST(ObservableCells, AreNeverUnknownOnes) {
  const World world = Look(test::ClutteredRoom(2000), At(2.0, 2.0, 30.0));
  int members = 0;
  for (std::size_t i = 0; i < world.seen.members.size(); ++i) {
    if (world.seen.members[i] == 0) continue;
    EXPECT_NE(world.truth.states[i], CellState::kUnknown);
    ++members;
  }
  EXPECT_GT(members, 300);
}

}  // namespace
}  // namespace depthgrid
