#include "sim/truth/band_polygon.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

// The plane x + y + z = 1.5 meets the unit cube in a hexagon; the triangle, around the same middle,
// cuts off every other of its corners.
TEST(BandPolygon, ATriangleHasNineCornersInACellAtMost) {
  TriangleMesh mesh;
  mesh.vertices = {{1.4334F, 0.5F, -0.4334F}, {0.5F, -0.4334F, 1.4334F}, {-0.4334F, 1.4334F, 0.5F}};
  mesh.triangles = {{0, 1, 2}};
  const BandPolygon band = InBand(mesh, mesh.triangles[0], {0.0, 1.0}, 1.0);
  const BandPolygon cell =
      band.Cut(1, 0.0, -1.0).Cut(1, 1.0, 1.0).Cut(0, 0.0, -1.0).Cut(0, 1.0, 1.0);
  EXPECT_EQ(cell.end() - cell.begin(), 9);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(cell.Min(axis), 0.0, 1e-9);
    EXPECT_NEAR(cell.Max(axis), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace depthgrid
