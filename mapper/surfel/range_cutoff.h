// A sensor reports no range beyond its reach: of a wall near it only those returns are left that
// noise made short, and their mean lies before the wall (docs/math.md, "Near the sensor's reach").
#pragma once

namespace depthgrid {

// What is left of a normal variable below a limit: its mean is mean - shortfall * sigma, and a
// value tells of the mean what `information` uncut ones do.
struct RangeCutoff {
  double shortfall = 0.0;
  double information = 1.0;
};

// `sigmas`: from the mean up to the limit.
RangeCutoff CutoffAt(double sigmas);

// Farther away nothing is cut off (less than 0.001 sigma).
inline constexpr double kUncutSigmas = 3.5;

}  // namespace depthgrid
