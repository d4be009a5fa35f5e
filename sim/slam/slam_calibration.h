// Scales a profile's drift so that the live poses have a given mean error.
#pragma once

#include <cstdint>

#include "mapper/core/trajectory.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

struct SeedRange {
  std::uint64_t first = 1;
  int count = 400;
};

// Mean over the seeds of the mean xy distance between live and true poses, without alignment: both
// start at the same pose. Frames without tracking are ignored.
double MeanLiveErrorM(const Trajectory& truth, const SlamOptions& options, const SeedRange& seeds);

struct DriftCalibration {
  double drift_scale = 0.0;
  double mean_error_m = 0.0;  // with that scale
  bool reached = false;       // false: no scale gives the target, and this is the nearest
};

// Finds the drift_scale with the target error over these seeds. Deterministic; all trials use the
// same random draws, so the error is a smooth function of the scale.
DriftCalibration CalibrateDrift(const Trajectory& truth, SlamOptions options, double target_m,
                                const SeedRange& seeds);

}  // namespace depthgrid
