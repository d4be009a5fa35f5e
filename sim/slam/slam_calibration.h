// Scaling a profile's drift until the live poses err as much as asked for.
#pragma once

#include <cstdint>

#include "mapper/core/trajectory.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

struct SeedRange {
  std::uint64_t first = 1;
  int count = 400;
};

// Mean over the seeds of the mean distance in xy between live and true poses; both start at the
// same pose, nothing is aligned, frames without tracking do not count.
double MeanLiveErrorM(const Trajectory& truth, const SlamOptions& options, const SeedRange& seeds);

struct DriftCalibration {
  double drift_scale = 0.0;
  double mean_error_m = 0.0;  // with that scale
  bool reached = false;       // false: no scale gives the target; the numbers are the nearest
};

// The drift_scale that gives the target over these seeds. A pure function of its arguments: the
// draws of all trials are the same, so the error is a smooth function of the scale.
DriftCalibration CalibrateDrift(const Trajectory& truth, SlamOptions options, double target_m,
                                const SeedRange& seeds);

}  // namespace depthgrid
