#include "sim/slam/slam_run.h"

#include <cmath>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Tolerance of the lag of a pair of poses: a quarter of a frame at 30 Hz.
constexpr double kLagToleranceS = 0.008;

}  // namespace

Pose3 MotionError(const SlamRun& run, std::size_t from, std::size_t to) {
  return Between(Between(run.truth[from].world_from_camera, run.truth[to].world_from_camera),
                 Between(run.estimate[from].world_from_camera, run.estimate[to].world_from_camera));
}

std::vector<LagError> ErrorOverLag(const std::vector<SlamRun>& runs,
                                   const std::vector<double>& lags_s) {
  std::vector<LagError> errors;
  for (const double lag_s : lags_s) {
    LagError error;
    error.lag_s = lag_s;
    for (const SlamRun& run : runs) {
      Require(run.truth.size() == run.estimate.size(), "each estimate belongs to a true pose");
      std::size_t to = 0;
      for (std::size_t from = 0; from < run.truth.size(); ++from) {
        const double due_s = run.truth[from].stamp_s + lag_s;
        while (to < run.truth.size() && run.truth[to].stamp_s < due_s - kLagToleranceS) ++to;
        if (to == run.truth.size()) break;
        if (run.truth[to].stamp_s > due_s + kLagToleranceS) continue;
        const Pose3 motion = MotionError(run, from, to);
        error.translation_m += motion.translation.squaredNorm();
        error.rotation_deg += std::pow(DegFromRad(LogRotation(motion.rotation).norm()), 2);
        ++error.pairs;
      }
    }
    if (error.pairs == 0) continue;
    error.translation_m = std::sqrt(error.translation_m / error.pairs);
    error.rotation_deg = std::sqrt(error.rotation_deg / error.pairs);
    errors.push_back(error);
  }
  return errors;
}

}  // namespace depthgrid
