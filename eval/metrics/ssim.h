// Structural similarity of a map, as a picture, to the true one.
#pragma once

#include <optional>

#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// Mean structural similarity (Wang et al. 2004) over the scored cells: Gaussian windows of 11 x 11
// cells with sigma 1.5, K1 = 0.01, K2 = 0.03, range 1, variances of the population. Free is 0,
// unknown 0.5 (also beyond the edges), occupied 1. All on one geometry; empty when nothing is
// scored.
std::optional<double> Ssim(const StateMap& truth, const StateMap& estimate, const CellSet& scored);

}  // namespace depthgrid
