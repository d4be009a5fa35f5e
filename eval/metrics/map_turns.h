// A map whose walls lie nowhere near the true ones may be turned or mirrored.
#pragma once

#include <optional>

#include "eval/metrics/map_registration.h"

namespace depthgrid {

struct MapTurn {
  int quarters = 0;       // that the estimate is to be turned by to lie over the truth, 0..3
  bool mirrored = false;  // before that, left and right
};

// The quarter turns and mirror images of the estimate, each laid with its middle on the truth's and
// registered from there: the one that lies over the truth's walls where the map as it is, whose F1
// at 10 cm after its own registration is given, does not. Geometries as of RegisterWalls().
std::optional<MapTurn> TurnOf(const StateMap& truth, const PlacedWalls& estimate,
                              const CellSet& scored, double registered_f1_10cm);

}  // namespace depthgrid
