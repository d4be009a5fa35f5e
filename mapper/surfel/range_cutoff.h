// A sensor reports no range beyond its reach. Of a wall near that, only returns that noise made
// short remain, and their mean lies before the wall (docs/math.md, "Near the sensor's reach").
#pragma once

namespace depthgrid {

// A normal variable truncated above: its mean is mean - shortfall * sigma, and one value has
// `information` times the Fisher information on the mean of an untruncated one.
struct RangeCutoff {
  double shortfall = 0.0;
  double information = 1.0;
};

// `sigmas`: distance from the mean up to the limit, in standard deviations.
RangeCutoff CutoffAt(double sigmas);

// From here on the truncation is negligible (shortfall below 0.001 sigma).
inline constexpr double kUncutSigmas = 3.5;

}  // namespace depthgrid
