#include "sim/truth/truth_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "tests/refusal.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;
using CellPairs = std::set<std::pair<int, int>>;

constexpr TruthGridOptions kOptions;  // 5 cm, 0.1 to 1.8 m

CellPairs Cells(const StateMap& map, CellState state) {
  CellPairs cells;
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    const Cell cell = map.geometry.CellAt(i);
    if (map.states[i] == state) cells.emplace(cell.x, cell.y);
  }
  return cells;
}

CellPairs OccupiedBy(const TriangleMesh& mesh, double floor_z_m = 0.0) {
  return Cells(SurfaceCells(mesh, floor_z_m, kOptions), CellState::kOccupied);
}

// A vertical wall between two points, from z = low to high.
TriangleMesh Wall(float x0, float y0, float x1, float y1, float low = 0.0F, float high = 2.5F) {
  TriangleMesh mesh;
  test::AddQuad(mesh, {x0, y0, low}, {x1, y1, low}, {x1, y1, high}, {x0, y0, high});
  return mesh;
}

TEST(SurfaceCells, OfAWallByHand) {
  EXPECT_EQ(OccupiedBy(Wall(0.12F, 0.01F, 0.12F, 0.16F)),
            (CellPairs{{2, 0}, {2, 1}, {2, 2}, {2, 3}}));
  // Both ends on cell corners: y = 0.2 belongs to the cell above.
  EXPECT_EQ(OccupiedBy(Wall(0.12F, 0.1F, 0.12F, 0.2F)), (CellPairs{{2, 2}, {2, 3}, {2, 4}}));
  EXPECT_EQ(OccupiedBy(Wall(-0.12F, -0.01F, -0.12F, -0.06F)), (CellPairs{{-3, -1}, {-3, -2}}));
}

TEST(SurfaceCells, AWallOnABoundaryBelongsToTheCellAbove) {
  // In single precision 0.7 and 20.3 lie below their boundaries and 4.9 above: neither may decide,
  // whether the band cuts the wall or holds it whole.
  for (const auto& [x, cell] : {std::pair{0.0F, 0},
                                {0.7F, 14},
                                {0.1F, 2},
                                {0.15F, 3},
                                {0.35F, 7},
                                {4.9F, 98},
                                {-0.7F, -14},
                                {20.3F, 406},
                                {25.35F, 507}}) {
    for (const auto& [low, high] : {std::pair{0.0F, 2.5F}, {0.5F, 0.6F}}) {
      EXPECT_EQ(OccupiedBy(Wall(x, 0.01F, x, 0.02F, low, high)), (CellPairs{{cell, 0}})) << x;
      EXPECT_EQ(OccupiedBy(Wall(0.01F, x, 0.02F, x, low, high)), (CellPairs{{0, cell}})) << x;
    }
  }
}

TEST(SurfaceCells, OfASlantedWallByHand) {
  // From (0.02, 0.01) to (0.13, 0.06): y reaches the second row at x = 0.108.
  EXPECT_EQ(OccupiedBy(Wall(0.02F, 0.01F, 0.13F, 0.06F)),
            (CellPairs{{0, 0}, {1, 0}, {2, 0}, {2, 1}}));
  // Exactly through corners: the diagonal, and nothing beside it.
  EXPECT_EQ(OccupiedBy(Wall(0.0F, 0.0F, 0.14F, 0.14F)), (CellPairs{{0, 0}, {1, 1}, {2, 2}}));
  // The falling diagonal passes through corners, each of which belongs to its upper right cell.
  EXPECT_EQ(OccupiedBy(Wall(0.01F, 0.09F, 0.09F, 0.01F)), (CellPairs{{0, 1}, {1, 1}, {1, 0}}));
}

TEST(SurfaceCells, NotOfTrianglesWithoutArea) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0.01F, 1}, {0.3F, 0.11F, 1}, {0.9F, 0.31F, 1}, {0.9F, 0.312F, 1}};
  mesh.triangles = {{0, 1, 2}};  // on a line but for rounding
  EXPECT_TRUE(OccupiedBy(mesh).empty());
  mesh.triangles = {{0, 2, 3}};  // 2 mm wide, 0.95 m long
  EXPECT_GE(OccupiedBy(mesh).size(), 18U);
}

TEST(SurfaceCells, OnlyInsideTheBand) {
  EXPECT_TRUE(OccupiedBy(Wall(0.1F, 0.01F, 0.1F, 0.02F, 0.0F, 0.09F)).empty());
  EXPECT_TRUE(OccupiedBy(Wall(0.1F, 0.01F, 0.1F, 0.02F, 1.81F, 2.5F)).empty());
  EXPECT_EQ(OccupiedBy(Wall(0.1F, 0.01F, 0.1F, 0.02F, 0.0F, 0.1F)).size(), 1U);
  EXPECT_EQ(OccupiedBy(Wall(0.1F, 0.01F, 0.1F, 0.02F, 1.8F, 2.5F)).size(), 1U);
  EXPECT_EQ(OccupiedBy(Wall(0.1F, 0.01F, 0.1F, 0.02F, 0.5F, 0.6F)).size(), 1U);
  // The band stands on the floor.
  EXPECT_TRUE(OccupiedBy(Wall(0.1F, 0.01F, 0.1F, 0.02F, 0.0F, 0.5F), -2.0).empty());
  EXPECT_EQ(OccupiedBy(Wall(0.1F, 0.01F, 0.1F, 0.02F, 0.0F, 0.5F), -1.0).size(), 1U);
}

TEST(SurfaceCells, ARampCountsFromWhereItEntersTheBand) {
  // Rises 0.1 m a cell: in the band from x = 0.05 (z = 0.1) to its end at x = 0.22 (z = 0.44).
  TriangleMesh ramp;
  test::AddQuad(ramp, {0, 0.01F, 0}, {0.22F, 0.01F, 0.44F}, {0.22F, 0.02F, 0.44F}, {0, 0.02F, 0});
  EXPECT_EQ(OccupiedBy(ramp), (CellPairs{{1, 0}, {2, 0}, {3, 0}, {4, 0}}));
}

TEST(SurfaceCells, ATableTopFillsItsCellsButASolidsInsideStaysEmpty) {
  TriangleMesh top;
  test::AddQuad(top, {0.01F, 0.01F, 0.45F}, {0.14F, 0.01F, 0.45F}, {0.14F, 0.12F, 0.45F},
                {0.01F, 0.12F, 0.45F});
  CellPairs expected;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) expected.emplace(x, y);
  }
  EXPECT_EQ(OccupiedBy(top), expected);
  // A column from floor to ceiling: its shell only.
  const TriangleMesh column = test::Box({0.01F, 0.01F, 0}, {0.14F, 0.14F, 2.5F});
  expected.erase({1, 1});
  EXPECT_EQ(OccupiedBy(column), expected);
}

// Whether a convex polygon has a point in the open square, by the separating axes of both.
bool OverlapsSquare(const std::vector<Vector2d>& polygon, double x, double y, double size) {
  const std::vector<Vector2d> square = {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
  const auto separates = [&](const Vector2d& axis) {
    const auto range = [&](const std::vector<Vector2d>& points) {
      double low = axis.dot(points[0]), high = low;
      for (const Vector2d& p : points) {
        low = std::min(low, axis.dot(p));
        high = std::max(high, axis.dot(p));
      }
      return std::pair{low, high};
    };
    const auto [low_a, high_a] = range(polygon);
    const auto [low_b, high_b] = range(square);
    return high_a <= low_b || high_b <= low_a;
  };
  if (separates({1, 0}) || separates({0, 1})) return false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (separates({-edge.y(), edge.x()})) return false;
  }
  return true;
}

TEST(SurfaceCells, AgreeWithSeparatingAxesOnRandomTriangles) {
  RandomStream random(1, RandomStage::kTest);
  int cells = 0;
  for (int i = 0; i < 500; ++i) {
    TriangleMesh mesh;
    std::vector<Vector2d> outline;
    for (int k = 0; k < 3; ++k) {
      const auto x = static_cast<float>(random.Uniform(-0.5, 0.5));
      const auto y = static_cast<float>(random.Uniform(-0.5, 0.5));
      mesh.vertices.emplace_back(x, y, static_cast<float>(random.Uniform(0.2, 1.7)));
      outline.emplace_back(x, y);
    }
    mesh.triangles.push_back({0, 1, 2});
    const CellPairs occupied = OccupiedBy(mesh);
    for (int x = -11; x <= 11; ++x) {
      for (int y = -11; y <= 11; ++y) {
        // Touching by less than the snapping of vertices may go either way.
        constexpr double kSize = 0.05, kSnap = 3e-5;
        const bool inner =
            OverlapsSquare(outline, kSize * x + kSnap, kSize * y + kSnap, kSize - 2 * kSnap);
        const bool outer =
            OverlapsSquare(outline, kSize * x - kSnap, kSize * y - kSnap, kSize + 2 * kSnap);
        if (inner != outer) continue;
        EXPECT_EQ(occupied.contains({x, y}), inner) << i << ": " << x << " " << y;
        ++cells;
      }
    }
  }
  EXPECT_GE(cells, 500 * 23 * 23 - 100);
}

Trajectory Path(const std::vector<Vector2d>& points) {
  Trajectory path;
  for (const Vector2d& p : points) {
    path.push_back({static_cast<double>(path.size()), CameraOf({p.x(), p.y(), 0.0}, 1.15)});
  }
  return path;
}

TEST(TruthMap, FreeIsWhatThePathReaches) {
  // Two closed rooms, the path in one of them.
  TriangleMesh mesh = test::Box({0.02F, 0.02F, 0}, {0.33F, 0.33F, 2.5F});
  Append(mesh, test::Box({0.52F, 0.02F, 0}, {0.83F, 0.33F, 2.5F}));
  const StateMap map = TruthMap(mesh, 0.0, Path({{0.17, 0.17}}), kOptions);
  EXPECT_EQ(map.geometry.min_cell, (Cell{0, 0}));
  EXPECT_EQ(map.geometry.width_cells, 17);
  EXPECT_EQ(map.geometry.height_cells, 7);
  EXPECT_EQ(map.At({3, 3}), CellState::kFree);
  EXPECT_EQ(map.At({0, 3}), CellState::kOccupied);
  EXPECT_EQ(map.At({13, 3}), CellState::kUnknown);
  EXPECT_EQ(map.At({8, 3}), CellState::kUnknown);
  EXPECT_EQ(Cells(map, CellState::kFree).size(), 25U);
}

TEST(TruthMap, DoesNotLeakThroughCorners) {
  StateMap map(GridGeometry{0.05, {0, 0}, 3, 3});
  for (const Cell& cell : {Cell{1, 0}, Cell{0, 1}, Cell{2, 1}, Cell{1, 2}}) {
    map.states[map.geometry.Index(cell)] = CellState::kOccupied;
  }
  FloodFree(map, {{1, 1}, {1, 0}, {7, 7}});
  EXPECT_EQ(Cells(map, CellState::kFree), (CellPairs{{1, 1}}));
}

TEST(TruthMap, HoldsThePathAndRefusesMillimetres) {
  const StateMap map = TruthMap(Wall(0.12F, 0.01F, 0.12F, 0.02F), 0.0,
                                Path({{-0.22, 0.01}, {0.01, 0.33}}), kOptions);
  EXPECT_EQ(map.geometry.min_cell, (Cell{-5, 0}));
  EXPECT_EQ(map.geometry.width_cells, 8);
  EXPECT_EQ(map.geometry.height_cells, 7);
  EXPECT_THROW(TruthMap(Wall(0, 0, 5000, 4900), 0.0, Path({{1, 1}}), kOptions), InputError);
}

TEST(TruthMap, APathOutOfAllReachIsRefused) {
  const Trajectory path = {{0.0, CameraOf({1.0, 1.0, 0.0}, 1.0)},
                           {0.1, CameraOf({1e6, 1e6, 0.0}, 1.0)}};
  const std::string refusal = RefusalOf([&] {
    TruthMap(test::Box({0, 0, 0}, {4, 3, 2}), 0.0, path, {});
  });
  EXPECT_THAT(refusal,
              testing::HasSubstr("truth map: the scene and the path are 20000001 x 20000001 "
                                 "cells of 0.05"));
}

}  // namespace
}  // namespace depthgrid
