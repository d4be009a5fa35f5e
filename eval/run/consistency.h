// Whether a run's errors are consistent with the covariances of the mapper (docs/metrics.md).
#pragma once

#include <optional>
#include <vector>

#include "eval/statistics/chi_square.h"
#include "mapper/core/frame_report.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {

// NIS: each match's innovation, weighted by the inverse covariance of prediction and match
// together. A match has as many degrees of freedom as directions that it constrains.
std::vector<ChiSquareSample> InnovationSamples(const std::vector<FrameReport>& reports);
int DirectionsSeen(const MatchResult& match);

// NEES: error of the online estimate's motion over each complete stretch
// (FrameReport::motion_from), against the poses of `truth` with the same stamps.
std::vector<ChiSquareSample> MotionSamples(const std::vector<FrameReport>& reports,
                                           const Trajectory& truth);

struct ConsistencyScores {
  std::optional<Consistency> nis;
  std::optional<Consistency> nees;
};
ConsistencyScores ScoreConsistency(const std::vector<FrameReport>& reports,
                                   const Trajectory& truth);

}  // namespace depthgrid
