// Bicubic interpolation of a submap's probabilities: the M_s of Eq. 4. Catmull-Rom splines through
// the cell centres, the same function as Ceres' BiCubicInterpolator, with second derivatives.
#pragma once

#include <array>

#include "mapper/match/probability_view.h"

namespace depthgrid {

// Value and derivatives with respect to metres of the map.
struct BicubicSample {
  double value = 0.0;
  double dx = 0.0;
  double dy = 0.0;
  double dxx = 0.0;
  double dxy = 0.0;
  double dyy = 0.0;
};

// The plain reference, in double; defined on the whole plane like the view. The function has
// continuous first derivatives; the second ones jump where a coordinate passes a cell's centre.
BicubicSample SampleBicubic(const ProbabilityView& view, const Eigen::Vector2d& point_in_map);
// The value alone, in a third of the time.
double BicubicValue(const ProbabilityView& view, const Eigen::Vector2d& point_in_map);

// The share of one axis in the value, which is the sum over 4 x 4 cells of the products of their
// two weights and their probability.
struct SplineAlongAxis {
  int first_cell = 0;
  std::array<double, 4> weights{};  // of this cell and the next three
};
SplineAlongAxis SplineAt(double coordinate_m, double resolution_m);

}  // namespace depthgrid
