// A level laser scan in `base` axes (x forward, y left): what every frame becomes before it is
// mapped.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

namespace depthgrid {

// One beam. It says three independent things, so that hit, "nothing within range" and "no data"
// stay apart: `hit`, an obstacle at range_m; the interval [clear_from_m, clear_to_m] along the
// bearing is free of obstacles through the whole band (empty when clear_to_m <= clear_from_m);
// everything else is unknown. For a hit clear_to_m <= range_m.
struct Beam {
  float bearing_rad = 0.0F;  // from base's x axis, counter-clockwise
  float range_m = 0.0F;      // horizontal distance of the obstacle; meaningful only when `hit`
  // Horizontal distances. Without a return, clear_to_m is the sensor's range; the mapper ignores
  // infinite beams.
  float clear_from_m = 0.0F;
  float clear_to_m = 0.0F;
  bool hit = false;

  bool operator==(const Beam&) const = default;
};

// A beam of the same bearing without hit or free space.
inline Beam Silent(const Beam& beam) { return {.bearing_rad = beam.bearing_rad}; }

// All beams start at base's origin. ScanOf() in mapper/io/carmen_log.h makes a Scan of laser
// readings.
struct Scan {
  // By increasing bearing; a ready scan given to the mapper may have any order.
  std::vector<Beam> beams;
  // The range limit the scan was made with; the mapper ignores hits beyond it. 0: unknown,
  // taken for kUsualReachM.
  double max_range_m = 0.0;

  bool operator==(const Scan&) const = default;
};

// On one surface, ranges of neighbouring beams differ by at most this times range times angle: the
// tangent of 85 degrees of incidence, beyond which hardly anything is returned.
constexpr double kSteepestTangent = 11.4;
// Nearer hits are ignored: many drivers write 0 for no return.
constexpr float kNearestHitM = 1e-3F;
// Range limit of a scan that does not state one: no planar scanner of a robot sees farther, and two
// false readings make no map that is too large to draw (kMaxMapCells).
constexpr double kUsualReachM = 250.0;
// No distance of a scan. A stated limit of this or more is taken for none.
constexpr double kFarthestSeenM = 1000.0;
// Two full turns, as scanners count bearings from different directions.
constexpr float kFarthestBearingRad = 4.0F * static_cast<float>(std::numbers::pi);

// False for a beam that no scanner of this range can have measured, and for NaN.
inline bool IsSound(const Beam& beam, float reach_m) {
  // The sum is finite only if all three are.
  const float known = beam.bearing_rad + beam.clear_from_m + beam.clear_to_m;
  if (!std::isfinite(known) || beam.clear_from_m < 0.0F) return false;
  if (std::abs(beam.bearing_rad) > kFarthestBearingRad) return false;
  return !beam.hit || (beam.range_m >= kNearestHitM && beam.range_m <= reach_m);
}

// Whether a mapper can have stored this beam, whatever the scan's range.
inline bool CanBeKept(const Beam& beam) {
  constexpr auto kReachM = static_cast<float>(kFarthestSeenM);
  return IsSound(beam, kReachM) && std::isfinite(beam.range_m) && beam.clear_to_m <= kReachM;
}

inline Eigen::Vector2d EndPoint(const Beam& beam) {
  return {beam.range_m * std::cos(beam.bearing_rad), beam.range_m * std::sin(beam.bearing_rad)};
}

}  // namespace depthgrid
