// A set of cells as a smooth function on the plane, for registration to a fraction of a cell.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/cell_set.h"

namespace depthgrid {

// Value and derivatives with respect to cells.
struct SplineSample {
  double value = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

// The sum of bicubic B-splines, one centred on each member. Along a row of cells they add up to a
// constant (partition of unity), so registration is not biased towards whole cells. With a radius
// the set is first smoothed by three box filters of 2 radius + 1 cells.
class SplineField {
 public:
  SplineField(const CellSet& set, int smoothing_radius_cells);

  // Anywhere on the plane; `position_cells` is in cells; a cell's centre is at its index + 0.5.
  SplineSample At(const Eigen::Vector2d& position_cells) const;

 private:
  GridGeometry geometry_;
  std::vector<double> values_;
};

}  // namespace depthgrid
