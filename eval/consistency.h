// Whether a run's errors are as large as the mapper said at the time (docs/metrics.md).
#pragma once

#include <vector>

#include "eval/statistics/chi_square.h"
#include "mapper/core/pose2.h"
#include "mapper/frame_report.h"

namespace depthgrid {

// NIS: each match's innovation against the covariance of prediction and match together. A match
// that does not see every direction has as many degrees of freedom as it sees.
std::vector<ChiSquareSample> InnovationSamples(const std::vector<FrameReport>& reports);
int DirectionsSeen(const MatchResult& match);

// One pose as known at the time, beside the truth.
struct JudgedPose {
  Pose2 truth;
  Pose2 estimate;
  Eigen::Matrix3d covariance;  // in base axes
};

// NEES of the motion from every pose to the one `frames` later, one after the other without
// overlap: with the length of a submap, how well the estimate agrees with the map that it is in.
// Both poses' covariances are those of a place in the map, independent of each other.
std::vector<ChiSquareSample> RelativeMotionSamples(const std::vector<JudgedPose>& poses,
                                                   int frames);
inline constexpr int kConsistencyFrames = 90;  // of a submap

}  // namespace depthgrid
