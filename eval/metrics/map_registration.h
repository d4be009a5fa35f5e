// Where an estimated map lies over the true one: the SE(2) motion that lays its walls over the true
// walls, to a fraction of a cell.
#pragma once

#include <optional>

#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

struct MapRegistration {
  Pose2 truth_from_estimate;
  // How far a point of the estimate's walls moves by it, on average, metres.
  double mean_shift_m = 0.0;
};

// Walls as a map's own cells have them, wherever their lattice lies in the truth's frame.
struct PlacedWalls {
  CellSet walls;
  Pose2 truth_from_cells;
};

// Maximises the correlation of the estimate's wall cells, each a point at its centre, with the true
// wall faces as a smooth hill (kernel correlation, Tsin and Kanade 2004), from coarse to fine:
// finds motions up to about 0.8 m. Faces are wall cells beside a free one: solid furniture would
// pull towards its middle, which no camera sees; for the same reason only true faces within two
// cells of the scored cells count. Empty when either map has none. The walls are moved as points:
// maps redrawn on the other lattice would lose thin walls that fall between two cells. `truth` and
// `scored` on one geometry; cells of one size.
std::optional<MapRegistration> RegisterWalls(const StateMap& truth, const PlacedWalls& estimate,
                                             const CellSet& scored);
// The walls of a map on the truth's lattice.
std::optional<MapRegistration> RegisterMap(const StateMap& truth, const StateMap& estimate,
                                           const CellSet& scored);

// A motion found otherwise, with how far it moves the walls.
MapRegistration RegistrationBy(const Pose2& truth_from_estimate, const PlacedWalls& estimate);

// The true faces that count.
CellSet FacesNear(const StateMap& truth, const CellSet& scored);

// Wall cells with a free cell among their eight neighbours.
CellSet WallFaces(const StateMap& map);

}  // namespace depthgrid
