// What tells parts of the robot from the room, to a laser (own_body.h) and a depth camera
// (body_mask.h) alike: they stay as near however the robot turns. Chosen; what that tells apart was
// tried on simulated lasers and rendered rooms (docs/formats.md).
#pragma once

#include <algorithm>
#include <cstddef>

namespace depthgrid {

// A view is one since whose forerunner the robot had turned by so much; so many are half a turn.
constexpr double kBodyViewTurnDeg = 20.0;
constexpr std::size_t kFewestBodyViews = 9;
constexpr double kMostBodyM = 1.0;

// What is no farther from a distance than this is at the same.
inline double BodyBandM(double distance_m) {
  constexpr double kBandM = 0.03;
  constexpr double kBandShare = 0.05;
  return std::max(kBandM, kBandShare * distance_m);
}

}  // namespace depthgrid
