// The matchers' view of a submap: the occupancy probability of every cell of the plane. Cells
// inside the rectangle have the stored value; never-seen cells (NaN) and everything outside the
// rectangle have one constant, so the function is defined on the whole plane and a view of a larger
// rectangle with NaN around it is the same view.
#pragma once

#include <cmath>

#include "mapper/core/grid_geometry.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

struct ProbabilityView {
  GridGeometry geometry;
  const float* occupied_prob = nullptr;  // geometry.size() values, row by row; NaN is "never seen"
  // Value of never-seen cells; ScanMatcher overwrites it with its own option.
  float unknown_prob = 0.5F;

  // In [0, 1] for every cell of the plane; never NaN.
  float At(const Cell& cell) const {
    if (!geometry.Contains(cell)) return unknown_prob;
    const float prob = occupied_prob[geometry.Index(cell)];
    return std::isnan(prob) ? unknown_prob : prob;
  }
};

// The view borrows from the map, which must outlive it.
inline ProbabilityView ViewOf(const OccupancyMap& map) {
  return {.geometry = map.geometry, .occupied_prob = map.occupied_prob.data()};
}

}  // namespace depthgrid
