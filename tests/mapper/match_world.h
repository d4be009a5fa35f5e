// Maps drawn from the walls of a planar world without any mapper, for tests of matching.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/core/occupancy_map.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {

inline void AddRectangle(PlanarWorld& world, double x0, double y0, double x1, double y1) {
  const PlanarWorld rectangle = RectangleWorld(x0, y0, x1, y1);
  world.insert(world.end(), rectangle.begin(), rectangle.end());
}

// 6 x 5 m with a cupboard, a table, a column and an oblique wall; around (3, 1.5) it is free.
inline PlanarWorld FurnishedRoom() {
  PlanarWorld world = RectangleWorld(0.0, 0.0, 6.0, 5.0);
  AddRectangle(world, 0.0, 3.4, 0.63, 4.61);
  AddRectangle(world, 4.02, 2.51, 4.87, 3.3);
  AddRectangle(world, 1.9, 4.6, 2.78, 5.0);
  world.push_back({{6.0, 4.1}, {5.2, 5.0}});
  return world;
}

// Two parallel walls along x, 2 m apart, without ends within any laser's range of the origin.
inline PlanarWorld StraightCorridor() {
  return {{{-30.0, -1.0}, {30.0, -1.0}}, {{-30.0, 1.0}, {30.0, 1.0}}};
}

inline double DistanceTo(const Wall& wall, const Eigen::Vector2d& point) {
  const Eigen::Vector2d along = wall.to - wall.from;
  const double share = std::clamp((point - wall.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (wall.from + share * along - point).norm();
}

// The probability of a cell falls off from 0.9 to 0.1 with the distance of its centre from the
// nearest wall (standard deviation one cell), so ridges lie on the walls exactly and nothing is
// rounded to cells.
inline OccupancyMap SmoothMap(const PlanarWorld& world, const Eigen::Vector2d& low,
                              const Eigen::Vector2d& high, double resolution_m) {
  GridGeometry geometry;
  geometry.resolution_m = resolution_m;
  geometry.min_cell = CellOf(low, resolution_m);
  const Cell last = CellOf(high, resolution_m);
  geometry.width_cells = last.x - geometry.min_cell.x + 1;
  geometry.height_cells = last.y - geometry.min_cell.y + 1;
  OccupancyMap map(geometry);
  for (std::size_t i = 0; i < map.occupied_prob.size(); ++i) {
    const Eigen::Vector2d centre = CellCentre(geometry.CellAt(i), resolution_m);
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Wall& wall : world) nearest_m = std::min(nearest_m, DistanceTo(wall, centre));
    const double cells = nearest_m / resolution_m;
    map.occupied_prob[i] = static_cast<float>(0.1 + 0.8 * std::exp(-0.5 * cells * cells));
  }
  return map;
}

}  // namespace depthgrid
