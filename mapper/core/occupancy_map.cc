#include "mapper/core/occupancy_map.h"

namespace depthgrid {

StateMap StatesOf(const OccupancyMap& map, const StateThresholds& thresholds) {
  StateMap states(map.geometry);
  for (std::size_t i = 0; i < map.occupied_prob.size(); ++i) {
    states.states[i] = StateOf(map.occupied_prob[i], thresholds);
  }
  return states;
}

}  // namespace depthgrid
