// Whether a map whose walls are nowhere near the true ones is rotated or mirrored.
#pragma once

#include <optional>

#include "eval/metrics/map_registration.h"

namespace depthgrid {

struct MapTurn {
  int quarters = 0;       // to rotate the estimate by, 0..3
  bool mirrored = false;  // left and right swapped, before that
};

// Tries the quarter turns and mirror images of the estimate, each centred on the truth and
// registered from there. Returns the one that fits the true walls, if the unturned map does not:
// `registered_f1_10cm` is its F1 at 10 cm after registration. Geometries as for RegisterWalls().
std::optional<MapTurn> TurnOf(const StateMap& truth, const PlacedWalls& estimate,
                              const CellSet& scored, double registered_f1_10cm);

}  // namespace depthgrid
