// Errors of an estimated trajectory against its reference. Conventions are evo's (1.9.1), except
// for planar errors (xy, SE(2)), which evo does not have.
#pragma once

#include <optional>
#include <vector>

#include "eval/metrics/association.h"
#include "eval/metrics/statistics.h"
#include "eval/metrics/trajectory_drift.h"

namespace depthgrid {

// Absolute pose errors, one per pair. The pairs are not aligned here.
std::vector<double> TranslationErrorsXy(const std::vector<PosePair>& pairs);   // metres, in xy
std::vector<double> TranslationErrorsXyz(const std::vector<PosePair>& pairs);  // metres
std::vector<double> RotationErrors(const std::vector<PosePair>& pairs);        // radians, 0..pi
// Of the bases, regardless of the cameras' tilt: radians, 0..pi.
std::vector<double> HeadingErrors(const std::vector<PosePair>& pairs);

// Indices of two pairs between which relative motion is compared. Steps are consecutive: 0, d, 2d,
// ...
struct RelativeStep {
  std::size_t from = 0;
  std::size_t to = 0;
};
std::vector<RelativeStep> StepsOfFrames(std::size_t pair_count, std::size_t delta_frames);
// By the estimate's path length: a step ends each time the path since the last end reaches
// `delta_m`, so the first step does not begin at the first pose (evo's rule).
std::vector<RelativeStep> StepsOfPath(const std::vector<PosePair>& pairs, double delta_m);

// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), with Q the reference and P the estimate: norm of its
// translation and angle of its rotation.
struct RelativeErrors {
  std::vector<double> translation_m;
  std::vector<double> rotation_rad;
};
RelativeErrors ErrorsOf(const std::vector<PosePair>& pairs, const std::vector<RelativeStep>& steps);

// All scores of one estimate. A part is empty where the positions do not determine the alignment or
// the trajectory is too short for one step.
struct TrajectoryScore {
  int reference_poses = 0;
  int estimate_poses = 0;
  int matched_poses = 0;
  bool by_row = false;            // paired by row, because a file had no stamps
  double reference_path_m = 0.0;  // over the matched poses
  double time_coverage = 0.0;     // TimeCoverage() of the reference
  Statistics xy_unaligned;        // metres; we take its mean to be that of the paper's Table 1
  Statistics xy_origin;           // Alignment::kPlanarOrigin
  std::optional<Statistics> xy_se2;
  Statistics xyz_unaligned;
  Statistics xyz_origin;
  std::optional<Statistics> xyz_se3;
  std::optional<Statistics> xyz_sim3;
  std::optional<double> sim3_scale;
  Statistics rotation_unaligned;  // radians
  std::optional<Statistics> rotation_se3;
  Statistics heading_unaligned;  // radians
  std::optional<Statistics> heading_se2;
  std::optional<Statistics> rpe_frame_translation;  // metres, delta one pose
  std::optional<Statistics> rpe_frame_rotation;     // radians
  std::optional<Statistics> rpe_metre_translation;  // metres, delta 1 m of path
  std::optional<Statistics> rpe_metre_rotation;
  std::vector<Drift> drift_over_time;  // at those of kDriftLagsS
  std::vector<Drift> drift_over_path;  // at those of kDriftLengthsM
};

// Share of the reference's poses that are matched, or that lie between matched ones at most a
// second apart (or three times the matched poses' median step, if that is longer).
double TimeCoverage(const Trajectory& reference, const std::vector<PosePair>& pairs);

// Empty when no stamps are shared.
std::optional<TrajectoryScore> ScoreTrajectory(const Trajectory& reference,
                                               const Trajectory& estimate,
                                               double max_difference_s = kMaxStampDifferenceS);

}  // namespace depthgrid
