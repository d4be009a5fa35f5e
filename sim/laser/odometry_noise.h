// Planar odometry that drifts: a prior for laser logs, calibrated to a stated mean error.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// The error of each frame's motion is a slowly varying bias (Ornstein-Uhlenbeck) and a white part,
// on all three axes, with a common scale chosen so that the mean Euclidean error over the run is
// `mean_error_m`. White jitter of the absolute pose may be added, as visual SLAM has and wheel
// odometry has not.
struct OdometryOptions {
  double mean_error_m = 0.375;
  double bias_time_frames = 65.0;  // correlation time of the bias: about 2 s at 30 Hz
  double jitter_m = 0.0;           // per axis
  double jitter_deg = 0.0;

  void Visit(OptionsVisitor& v);
};

// One pose per true pose; the first is exact. Throws SettingError if no scale gives the mean error.
std::vector<Pose2> DisturbOdometry(const std::vector<Pose2>& truth, const OdometryOptions& options,
                                   std::uint64_t seed);

}  // namespace depthgrid
