// Small maps drawn as text, and a room that can be moved.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/map_registration.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// Rows from the top (largest y) down: '#' occupied, '.' free, '?' unknown.
inline StateMap DrawnMap(const std::vector<std::string>& rows, double resolution_m = 0.05,
                         const Cell& min_cell = {}) {
  StateMap map(GridGeometry{resolution_m, min_cell, static_cast<int>(rows[0].size()),
                            static_cast<int>(rows.size())});
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      const std::size_t index = (rows.size() - 1 - r) * rows[0].size() + c;
      map.states[index] = rows[r][c] == '#'   ? CellState::kOccupied
                          : rows[r][c] == '.' ? CellState::kFree
                                              : CellState::kUnknown;
    }
  }
  return map;
}

// A room of 4 x 3 m with a cupboard, a partition and a slanted wall, as a map with the room at
// `map_from_room`: occupied where a wall's line passes, free inside.
inline StateMap MovedRoom(const Pose2& map_from_room, double resolution_m = 0.05) {
  struct Line {
    Eigen::Vector2d a, b;
  };
  const std::vector<Line> walls = {{{0, 0}, {4, 0}},       {{4, 0}, {4, 3}},
                                   {{4, 3}, {0, 3}},       {{0, 3}, {0, 0}},
                                   {{1, 1.2}, {1.5, 1.2}}, {{1.5, 1.2}, {1.5, 1.7}},
                                   {{1.5, 1.7}, {1, 1.7}}, {{1, 1.7}, {1, 1.2}},
                                   {{2.5, 0}, {2.5, 1.1}}, {{3, 3}, {4, 2.2}}};
  const int cells = static_cast<int>(6.0 / resolution_m);
  const int first = static_cast<int>(-1.0 / resolution_m);
  StateMap map(GridGeometry{resolution_m, {first, first}, cells, cells});
  const Pose2 room_from_map = Inverse(map_from_room);
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    const Eigen::Vector2d p = room_from_map * CellCentre(map.geometry.CellAt(i), resolution_m);
    const bool inside = p.x() > 0 && p.x() < 4 && p.y() > 0 && p.y() < 3;
    const bool beyond_slant = (p.x() - 3) * 0.8 + (p.y() - 3) > 0;
    const bool in_cupboard = p.x() > 1 && p.x() < 1.5 && p.y() > 1.2 && p.y() < 1.7;
    if (inside && !beyond_slant && !in_cupboard) map.states[i] = CellState::kFree;
  }
  for (const Line& wall : walls) {
    const double step_m = 0.1 * resolution_m;
    const int steps = static_cast<int>((wall.b - wall.a).norm() / step_m) + 1;
    for (int k = 0; k <= steps; ++k) {
      const Eigen::Vector2d p =
          map_from_room * Eigen::Vector2d(wall.a + (wall.b - wall.a) * k / steps);
      map.states[map.geometry.Index(CellOf(p, resolution_m))] = CellState::kOccupied;
    }
  }
  return map;
}

inline CellSet Everywhere(const GridGeometry& geometry) {
  CellSet all(geometry);
  std::fill(all.members.begin(), all.members.end(), std::uint8_t{1});
  return all;
}

// RegisterWalls() for a map on the truth's grid.
inline std::optional<MapRegistration> RegisterMap(const StateMap& truth, const StateMap& estimate,
                                                  const CellSet& scored) {
  return RegisterWalls(truth, {CellsIn(estimate, CellState::kOccupied), {}}, scored);
}

}  // namespace depthgrid
