// A planar world of wall segments and the laser scanner that looks at it: the testbed for laser
// logs, where truth is exact and a frame costs microseconds (docs/results.md, "Laser logs").
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

struct WallSegment {
  Eigen::Vector2d a_m;
  Eigen::Vector2d b_m;
};

struct LaserWorld {
  std::vector<WallSegment> walls;
};

// One segment "x1 y1 x2 y2" a line; '#' begins a comment. Throws InputError for anything else and
// for a file without segments.
LaserWorld ReadLaserWorld(const std::string& path);

struct LaserOptions {
  int beams = 640;
  double field_of_view_deg = 58.0;
  double min_range_m = 0.4;
  double max_range_m = 6.0;
  // Standard deviation of a range r: relative * r + quadratic * r^2. 1 % is typical of a cheap
  // scanner; 0.003 per metre without the relative part resembles a structured-light camera.
  double noise_relative = 0.01;
  double noise_quadratic_per_m = 0.0;
  // Correlation of the noise of neighbouring beams (first-order autoregressive).
  double noise_correlation = 0.0;
  double outlier_share = 0.0;  // share of beams with a uniformly random range

  void Visit(OptionsVisitor& v);
  double BearingStepRad() const;
  double FirstBearingRad() const;
};

// The exact range of each beam; infinity where no wall is.
std::vector<double> CastScan(const LaserWorld& world, const Pose2& world_from_laser,
                             const LaserOptions& options);

// What the scanner reports for exact ranges: noise, 0 for too near, the maximum for too far.
std::vector<double> DisturbScan(const std::vector<double>& exact_range_m,
                                const LaserOptions& options, std::uint64_t seed, int frame);

}  // namespace depthgrid
