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
  // Horizontal distances. Where nothing came back, as far as the sensor would have seen something:
  // the mapper leaves out what is infinite.
  float clear_from_m = 0.0F;
  float clear_to_m = 0.0F;
  bool hit = false;

  bool operator==(const Beam&) const = default;
};

// A beam there that says nothing.
inline Beam Silent(const Beam& beam) { return {.bearing_rad = beam.bearing_rad}; }

// Their origin is base's origin. Of a laser's readings ScanOf() in mapper/io/carmen_log.h makes
// one.
struct Scan {
  // By increasing bearing; of a ready scan given to the mapper in any order.
  std::vector<Beam> beams;
  // The range limit the scan was made with; no hit lies beyond it: the mapper ignores such. 0:
  // unknown.
  double max_range_m = 0.0;

  bool operator==(const Scan&) const = default;
};

// Between neighbouring beams ranges change by this times the range and the angle at most, unless
// they lie on two surfaces: the tangent of 85 degrees, at which hardly anything comes back.
constexpr double kSteepestTangent = 11.4;
// A hit nearer than this is no surface: many drivers write 0 where nothing came back.
constexpr float kNearestHitM = 1e-3F;
// What no scanner of robots sees past, where a scan does not say how far it reaches.
constexpr double kFarthestSeenM = 1000.0;
// Twice round, from wherever the scanner counts.
constexpr float kFarthestBearingRad = 4.0F * static_cast<float>(std::numbers::pi);

// False for a beam that no scanner of this reach can have seen, and for NaN.
inline bool IsSound(const Beam& beam, float reach_m) {
  // One sum tells of three numbers whether all are finite.
  const float known = beam.bearing_rad + beam.clear_from_m + beam.clear_to_m;
  if (!std::isfinite(known) || beam.clear_from_m < 0.0F) return false;
  if (std::abs(beam.bearing_rad) > kFarthestBearingRad) return false;
  return !beam.hit || (beam.range_m >= kNearestHitM && beam.range_m <= reach_m);
}

// What a mapper can have kept, whatever the scan's reach was.
inline bool CanBeKept(const Beam& beam) {
  constexpr auto kReachM = static_cast<float>(kFarthestSeenM);
  return IsSound(beam, kReachM) && std::isfinite(beam.range_m) && beam.clear_to_m <= kReachM;
}

inline Eigen::Vector2d EndPoint(const Beam& beam) {
  return {beam.range_m * std::cos(beam.bearing_rad), beam.range_m * std::sin(beam.bearing_rad)};
}

}  // namespace depthgrid
