// Whether a run's errors are as large as the mapper said at the time (docs/metrics.md).
#pragma once

#include <optional>
#include <vector>

#include "eval/statistics/chi_square.h"
#include "mapper/core/frame_report.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {

// NIS: each match's innovation against the covariance of prediction and match together. A match
// that does not see every direction has as many degrees of freedom as it sees.
std::vector<ChiSquareSample> InnovationSamples(const std::vector<FrameReport>& reports);
int DirectionsSeen(const MatchResult& match);

// NEES: the motion of the online estimate over each whole stretch that the mapper told
// (FrameReport::motion_from) against that of the poses of `truth` with the same stamps.
std::vector<ChiSquareSample> MotionSamples(const std::vector<FrameReport>& reports,
                                           const Trajectory& truth);

struct ConsistencyScores {
  std::optional<Consistency> nis;
  std::optional<Consistency> nees;
};
ConsistencyScores ScoreConsistency(const std::vector<FrameReport>& reports,
                                   const Trajectory& truth);

}  // namespace depthgrid
