// Angles in radians, wrapped to (-pi, pi]; degrees only exist as `_deg` configuration keys.
#pragma once

#include <cmath>
#include <numbers>

namespace depthgrid {

constexpr double kPi = std::numbers::pi;

constexpr double RadFromDeg(double angle_deg) { return angle_deg * (kPi / 180.0); }
constexpr double DegFromRad(double angle_rad) { return angle_rad * (180.0 / kPi); }

// The same angle in (-pi, pi]. Exact (returned unchanged) when it already lies there.
inline double WrapAngle(double angle_rad) {
  if (angle_rad > -kPi && angle_rad <= kPi) return angle_rad;
  const double wrapped_rad = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped_rad <= -kPi ? kPi : wrapped_rad;
}

}  // namespace depthgrid
