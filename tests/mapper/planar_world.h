// Flat worlds of wall segments, and the scan an ideal laser would see in them.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/core/rng.h"
#include "mapper/core/scan.h"

namespace depthgrid {

struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

using PlanarWorld = std::vector<Wall>;

struct PlanarLaser {
  int beams = 640;
  double field_of_view_rad = RadFromDeg(67.25);  // ICL-NUIM's
  double min_range_m = 0.4;
  double max_range_m = 6.0;
  double sigma_of_range = 0.0;  // standard deviation as a share of the range
};

inline PlanarWorld RectangleWorld(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}}, {{x1, y0}, {x1, y1}}, {{x1, y1}, {x0, y1}}, {{x0, y1}, {x0, y0}}};
}

// The distance to the nearest wall along a ray, if any is hit.
inline std::optional<double> CastRay(const PlanarWorld& world, const Eigen::Vector2d& origin,
                                     const Eigen::Vector2d& direction) {
  std::optional<double> nearest;
  for (const Wall& wall : world) {
    const Eigen::Vector2d along = wall.to - wall.from;
    const double cross = direction.x() * along.y() - direction.y() * along.x();
    if (std::abs(cross) < 1e-15) continue;
    const Eigen::Vector2d offset = wall.from - origin;
    const double range = (offset.x() * along.y() - offset.y() * along.x()) / cross;
    const double share = (offset.x() * direction.y() - offset.y() * direction.x()) / cross;
    if (range <= 0.0 || share < 0.0 || share > 1.0) continue;
    if (!nearest || range < *nearest) nearest = range;
  }
  return nearest;
}

// Beams evenly spaced in bearing. Beams without a hit are free up to the range limit.
inline Scan ScanOf(const PlanarWorld& world, const Pose2& world_from_base, const PlanarLaser& laser,
                   std::uint64_t seed = 0, std::uint32_t frame = 0) {
  RandomStream random(seed, RandomStage::kTest, frame);
  Scan scan;
  scan.max_range_m = laser.max_range_m;
  for (int i = 0; i < laser.beams; ++i) {
    const double bearing_rad = laser.field_of_view_rad * ((i + 0.5) / laser.beams - 0.5);
    const double heading_rad = world_from_base.yaw_rad + bearing_rad;
    const std::optional<double> range = CastRay(world, world_from_base.translation(),
                                                {std::cos(heading_rad), std::sin(heading_rad)});
    const double noise = 1.0 + laser.sigma_of_range * random.Normal();
    const double measured_m = range ? *range * noise : 2.0 * laser.max_range_m;
    Beam beam;
    beam.bearing_rad = static_cast<float>(bearing_rad);
    beam.hit = measured_m >= laser.min_range_m && measured_m <= laser.max_range_m;
    if (beam.hit) beam.range_m = static_cast<float>(measured_m);
    if (measured_m >= laser.min_range_m) {
      beam.clear_from_m = static_cast<float>(laser.min_range_m);
      beam.clear_to_m = static_cast<float>(std::min(measured_m, laser.max_range_m));
    }
    scan.beams.push_back(beam);
  }
  return scan;
}

}  // namespace depthgrid
