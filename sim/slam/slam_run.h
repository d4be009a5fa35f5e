// A recorded run of a SLAM system with the true poses, and the errors of its motions.
#pragma once

#include <vector>

#include "mapper/core/trajectory.h"

namespace depthgrid {

// Pose i of the estimate belongs to pose i of the truth. Both have a gap where tracking was lost.
struct SlamRun {
  Trajectory truth;
  Trajectory estimate;

  // Time between the pose before `to` and `to`.
  double StepS(std::size_t to) const { return truth[to].stamp_s - truth[to - 1].stamp_s; }
};

// The error of the estimated motion between two poses, in axes of the camera at the later one.
Pose3 MotionError(const SlamRun& run, std::size_t from, std::size_t to);

// Root mean square error of the motion over a time lag.
struct LagError {
  double lag_s = 0.0;
  double translation_m = 0.0;  // all three axes together
  double rotation_deg = 0.0;
  int pairs = 0;
};

// Over all pairs of poses at each lag, of all runs; lags longer than every run are omitted.
std::vector<LagError> ErrorOverLag(const std::vector<SlamRun>& runs,
                                   const std::vector<double>& lags_s);

}  // namespace depthgrid
