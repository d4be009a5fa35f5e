// Maps judged without any truth, by what blurred and doubled walls look like.
#pragma once

#include <optional>

#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// Filatov et al. 2017, measures that need no truth; blurred and doubled walls raise each of them.
struct TruthlessScore {
  std::optional<double> occupied_share;  // occupied cells of all known ones
  int corners = 0;                       // where walls end, meet or bend (Harris)
  int enclosed_areas = 0;  // patches of cells that walls shut off from the rest of the plane
};
TruthlessScore ScoreWithoutTruth(const StateMap& map);

}  // namespace depthgrid
