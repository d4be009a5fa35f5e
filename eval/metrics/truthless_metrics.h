// Map scores without ground truth, which react to blurred and doubled walls.
#pragma once

#include <optional>

#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// Measures of Filatov et al. 2017. Blurred and doubled walls raise each of them.
struct TruthlessScore {
  std::optional<double> occupied_share;  // occupied cells of all known ones
  int corners = 0;                       // where walls end, meet or bend (Harris)
  int enclosed_areas = 0;  // connected areas that walls separate from the map's border
};
TruthlessScore ScoreWithoutTruth(const StateMap& map);

}  // namespace depthgrid
