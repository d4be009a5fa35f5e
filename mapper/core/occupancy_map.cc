#include "mapper/core/occupancy_map.h"

#include <cmath>

namespace depthgrid {

OccupancyMap CertainMap(const StateMap& map) {
  OccupancyMap certain(map.geometry);
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    if (map.states[i] != CellState::kUnknown) {
      certain.occupied_prob[i] = map.states[i] == CellState::kOccupied ? 1.0F : 0.0F;
    }
  }
  return certain;
}

StateMap StatesOf(const OccupancyMap& map) {
  StateMap states(map.geometry);
  for (std::size_t i = 0; i < map.occupied_prob.size(); ++i) {
    states.states[i] = StateOf(map.occupied_prob[i]);
  }
  return states;
}

GridGeometry ChangedBetween(const OccupancyMap& before, const OccupancyMap& after) {
  const GridGeometry both = Union(before.geometry, after.geometry);
  GridGeometry changed;
  changed.resolution_m = both.resolution_m;
  for (std::size_t i = 0; i < both.size(); ++i) {
    const Cell cell = both.CellAt(i);
    const float was = before.At(cell), is = after.At(cell);
    const bool same = was == is || (std::isnan(was) && std::isnan(is));
    if (!same) changed = Union(changed, OnlyCell(cell, both.resolution_m));
  }
  return changed;
}

}  // namespace depthgrid
