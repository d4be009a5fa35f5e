// Registers an estimated map with the true one: the SE(2) motion that moves its walls onto the true
// walls, to a fraction of a cell.
#pragma once

#include <optional>

#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

struct MapRegistration {
  Pose2 truth_from_estimate;
  // Mean distance that it moves the estimate's wall cells, metres.
  double mean_shift_m = 0.0;
};

// Walls on a map's own grid, and the pose of that grid in the truth's frame.
struct PlacedWalls {
  CellSet walls;
  Pose2 truth_from_cells;
};

// Maximises the correlation of the estimate's wall cells, each a point at its centre, with a smooth
// field of the true wall faces (kernel correlation, Tsin and Kanade 2004), from coarse to fine.
// Finds motions up to about 0.8 m. Faces are wall cells beside a free one, because the inside of
// solid furniture, which no camera sees, would attract the walls. For the same reason only true
// faces within two cells of the scored cells count. Empty when either map has none. The walls are
// moved as points: a map resampled to the other grid would lose thin walls that fall between two
// cells. `truth` and `scored` have the same geometry; all cells have the same size.
std::optional<MapRegistration> RegisterWalls(const StateMap& truth, const PlacedWalls& estimate,
                                             const CellSet& scored);

// A registration from a motion found by other means.
MapRegistration RegistrationBy(const Pose2& truth_from_estimate, const PlacedWalls& estimate);

// The true faces that RegisterWalls() counts.
CellSet FacesNear(const StateMap& truth, const CellSet& scored);

// Wall cells with a free cell among their eight neighbours.
CellSet WallFaces(const StateMap& map);

}  // namespace depthgrid
