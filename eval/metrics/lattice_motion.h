// What whole cells know of where a map lies: of walls along the lattice, only which cells they are.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/cell_set.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// Whether most wall cells are of walls along the rows or columns: of straight runs that do not go
// on in the next row, as a wall across the lattice does, whose steps tell its place within a cell.
bool LieAlongLattice(const CellSet& walls);

// The pose near `truth_from_cells` that lays cells of one lattice over cells of the other: of the
// nine about it the one that lays most of the cells at `centres_m` over true walls.
Pose2 OntoLattice(const CellSet& true_walls, const std::vector<Eigen::Vector2d>& centres_m,
                  const Pose2& truth_from_cells);

}  // namespace depthgrid
