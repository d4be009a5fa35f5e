// Criteria for parts of the robot in the view of its laser (own_body.h) or depth camera
// (body_mask.h): their distance stays constant while the robot turns. The values were chosen and
// tested on simulated lasers and rendered rooms (docs/formats.md).
#pragma once

#include <algorithm>
#include <cstddef>

namespace depthgrid {

// The robot turns by this much between two views; this many views are half a turn.
constexpr double kBodyViewTurnDeg = 20.0;
constexpr std::size_t kFewestBodyViews = 9;
constexpr double kMostBodyM = 1.0;

// Distances that differ by at most this count as the same.
inline double BodyBandM(double distance_m) {
  constexpr double kBandM = 0.03;
  constexpr double kBandShare = 0.05;
  return std::max(kBandM, kBandShare * distance_m);
}

}  // namespace depthgrid
