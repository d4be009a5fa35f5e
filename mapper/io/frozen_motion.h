// Motion of a sensor with unchanging data beyond which its driver is taken to be frozen.
#pragma once

#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {

// 2 degrees or 5 cm plus as much per second, more than SLAM and odometry drift while the sensor
// stands. Chosen, not measured.
inline bool IsFrozenTurn(double turn_rad, double seconds) {
  return std::abs(turn_rad) > RadFromDeg(2.0) * (1.0 + seconds);
}
inline double FrozenWayM(double seconds) { return 0.05 * (1.0 + seconds); }

}  // namespace depthgrid
