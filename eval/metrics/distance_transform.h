// Exact distances from every cell to the nearest member of a set, and dilation of sets.
#pragma once

#include <vector>

#include "mapper/core/cell_set.h"

namespace depthgrid {

// Squared Euclidean distance between cell centres, in cells^2, in the mask's cell order; infinite
// everywhere for an empty set. Felzenszwalb and Huttenlocher 2012, linear in the number of cells.
std::vector<double> SquaredDistances(const CellSet& mask);

// Dilation: every cell of the same rectangle within `radius_cells` of a member, Chebyshev distance
// (diagonal steps count one).
CellSet Grown(const CellSet& mask, int radius_cells);

}  // namespace depthgrid
