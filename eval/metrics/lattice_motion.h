// Registration by whole cells, for maps whose walls run along the grid: their cells do not tell
// where within a cell a wall lies.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/cell_set.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// Whether most wall cells belong to walls along the rows or columns, that is, to straight runs that
// do not continue in the next row. A wall at an angle to the grid does continue there, and its
// steps tell its position within a cell.
bool LieAlongLattice(const CellSet& walls);

// Of the nine poses around `truth_from_cells` that map cells of one grid onto cells of the other,
// the one that maps most of the cells at `centres_m` onto true walls.
Pose2 OntoLattice(const CellSet& true_walls, const std::vector<Eigen::Vector2d>& centres_m,
                  const Pose2& truth_from_cells);

}  // namespace depthgrid
