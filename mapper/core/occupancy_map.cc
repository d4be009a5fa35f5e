#include "mapper/core/occupancy_map.h"

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

}  // namespace depthgrid
