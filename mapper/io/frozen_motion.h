// How far a sensor goes that gives the same again and again, before that is its driver's fault.
#pragma once

#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {

// 2 degrees or 5 cm, and as much for each second: SLAM and odometry that wander while the sensor
// stands do not go so far. Chosen, of no measurement.
inline bool IsFrozenTurn(double turn_rad, double seconds) {
  return std::abs(turn_rad) > RadFromDeg(2.0) * (1.0 + seconds);
}
inline double FrozenWayM(double seconds) { return 0.05 * (1.0 + seconds); }

}  // namespace depthgrid
