// The part of a map that a matcher copies.
#pragma once

#include "mapper/match/match_points.h"
#include "mapper/match/search_lattice.h"

namespace depthgrid {

// A rectangle of the map's cells that holds the cells of all points at a pose and `reach_cells`
// around them. It is clipped to the map and `border_cells` of the unknown around it, so that its
// size is bounded by the map's, and is at least `border_cells` + 1 wide and high.
GridGeometry ReachedCells(const MatchPoints& points, const PointCells& at_pose, int reach_cells,
                          const GridGeometry& map, int border_cells);

}  // namespace depthgrid
