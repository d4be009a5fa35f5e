#include "eval/metrics/trajectory_metrics.h"

#include <algorithm>
#include <cmath>

#include "eval/metrics/alignment.h"
#include "mapper/core/level.h"
#include "mapper/core/median.h"

namespace depthgrid {
namespace {

Eigen::Vector3d ShiftOf(const PosePair& pair) {
  return pair.estimate.world_from_camera.translation - pair.reference.world_from_camera.translation;
}

template <typename ErrorOfPair>
std::vector<double> ErrorOfEach(const std::vector<PosePair>& pairs, ErrorOfPair error_of) {
  std::vector<double> errors;
  errors.reserve(pairs.size());
  for (const PosePair& pair : pairs) errors.push_back(error_of(pair));
  return errors;
}

std::optional<Statistics> SummariseIfAny(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return Summarise(values);
}

// Never empty: the first pair determines these alignments.
std::vector<PosePair> AlignedAtOrigin(const std::vector<PosePair>& pairs, Alignment alignment) {
  return Aligned(pairs, *Align(pairs, alignment));
}

void ScoreAbsolute(const std::vector<PosePair>& pairs, TrajectoryScore& score) {
  score.xy_unaligned = Summarise(TranslationErrorsXy(pairs));
  score.xyz_unaligned = Summarise(TranslationErrorsXyz(pairs));
  score.rotation_unaligned = Summarise(RotationErrors(pairs));
  score.heading_unaligned = Summarise(HeadingErrors(pairs));
  score.xy_origin =
      Summarise(TranslationErrorsXy(AlignedAtOrigin(pairs, Alignment::kPlanarOrigin)));
  score.xyz_origin = Summarise(TranslationErrorsXyz(AlignedAtOrigin(pairs, Alignment::kOrigin)));
  if (const auto transform = Align(pairs, Alignment::kSe2)) {
    const auto aligned = Aligned(pairs, *transform);
    score.xy_se2 = Summarise(TranslationErrorsXy(aligned));
    score.heading_se2 = Summarise(HeadingErrors(aligned));
  }
  if (const auto transform = Align(pairs, Alignment::kSe3)) {
    const auto aligned = Aligned(pairs, *transform);
    score.xyz_se3 = Summarise(TranslationErrorsXyz(aligned));
    score.rotation_se3 = Summarise(RotationErrors(aligned));
  }
  if (const auto transform = Align(pairs, Alignment::kSim3)) {
    score.xyz_sim3 = Summarise(TranslationErrorsXyz(Aligned(pairs, *transform)));
    score.sim3_scale = transform->scale;
  }
}

void ScoreRelative(const std::vector<PosePair>& pairs, TrajectoryScore& score) {
  constexpr std::size_t kDeltaFrames = 1;
  constexpr double kDeltaM = 1.0;
  const RelativeErrors by_frame = ErrorsOf(pairs, StepsOfFrames(pairs.size(), kDeltaFrames));
  score.rpe_frame_translation = SummariseIfAny(by_frame.translation_m);
  score.rpe_frame_rotation = SummariseIfAny(by_frame.rotation_rad);
  const RelativeErrors by_metre = ErrorsOf(pairs, StepsOfPath(pairs, kDeltaM));
  score.rpe_metre_translation = SummariseIfAny(by_metre.translation_m);
  score.rpe_metre_rotation = SummariseIfAny(by_metre.rotation_rad);
}

void ScoreDrift(const std::vector<PosePair>& pairs, TrajectoryScore& score) {
  for (const double lag_s : kDriftLagsS) {
    if (const auto drift = DriftOverTime(pairs, lag_s)) score.drift_over_time.push_back(*drift);
  }
  for (const double length_m : kDriftLengthsM) {
    if (const auto drift = DriftOverPath(pairs, length_m)) score.drift_over_path.push_back(*drift);
  }
}

}  // namespace

std::vector<double> TranslationErrorsXy(const std::vector<PosePair>& pairs) {
  return ErrorOfEach(pairs, [](const PosePair& pair) { return ShiftOf(pair).head<2>().norm(); });
}

std::vector<double> TranslationErrorsXyz(const std::vector<PosePair>& pairs) {
  return ErrorOfEach(pairs, [](const PosePair& pair) { return ShiftOf(pair).norm(); });
}

std::vector<double> RotationErrors(const std::vector<PosePair>& pairs) {
  return ErrorOfEach(pairs, [](const PosePair& pair) {
    return AngleOf(pair.estimate.world_from_camera.rotation.conjugate() *
                   pair.reference.world_from_camera.rotation);
  });
}

std::vector<double> HeadingErrors(const std::vector<PosePair>& pairs) {
  return ErrorOfEach(pairs, [](const PosePair& pair) {
    const double turn_rad = BaseOf(pair.estimate.world_from_camera).yaw_rad -
                            BaseOf(pair.reference.world_from_camera).yaw_rad;
    return std::abs(WrapAngle(turn_rad));
  });
}

std::vector<RelativeStep> StepsOfFrames(std::size_t pair_count, std::size_t delta_frames) {
  std::vector<RelativeStep> steps;
  for (std::size_t to = delta_frames; to < pair_count; to += delta_frames) {
    steps.push_back({to - delta_frames, to});
  }
  return steps;
}

std::vector<RelativeStep> StepsOfPath(const std::vector<PosePair>& pairs, double delta_m) {
  std::vector<RelativeStep> steps;
  std::optional<std::size_t> last_point;
  double path_m = 0.0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    path_m += (pairs[i].estimate.world_from_camera.translation -
               pairs[i - 1].estimate.world_from_camera.translation)
                  .norm();
    if (path_m < delta_m) continue;
    if (last_point) steps.push_back({*last_point, i});
    last_point = i;
    path_m = 0.0;
  }
  return steps;
}

RelativeErrors ErrorsOf(const std::vector<PosePair>& pairs,
                        const std::vector<RelativeStep>& steps) {
  RelativeErrors errors;
  for (const auto& [from, to] : steps) {
    const Pose3 reference =
        Between(pairs[from].reference.world_from_camera, pairs[to].reference.world_from_camera);
    const Pose3 estimate =
        Between(pairs[from].estimate.world_from_camera, pairs[to].estimate.world_from_camera);
    const Pose3 error = Between(reference, estimate);
    errors.translation_m.push_back(error.translation.norm());
    errors.rotation_rad.push_back(AngleOf(error.rotation));
  }
  return errors;
}

double TimeCoverage(const Trajectory& reference, const std::vector<PosePair>& pairs) {
  constexpr double kShortGapS = 1.0;
  constexpr double kShortGapSteps = 3.0;
  std::vector<double> stamps_s, steps_s;
  for (const PosePair& pair : pairs) stamps_s.push_back(pair.reference.stamp_s);
  for (std::size_t i = 1; i < pairs.size(); ++i) steps_s.push_back(stamps_s[i] - stamps_s[i - 1]);
  const double step_s = steps_s.empty() ? 0.0 : UpperMedian(std::move(steps_s));
  const double short_gap_s = std::max(kShortGapS, kShortGapSteps * step_s);
  const auto is_covered = [&](const StampedPose& pose) {
    const auto next = std::lower_bound(stamps_s.begin(), stamps_s.end(), pose.stamp_s);
    if (next == stamps_s.end()) return false;
    if (*next == pose.stamp_s) return true;
    return next != stamps_s.begin() && *next - *std::prev(next) <= short_gap_s;
  };
  const auto covered = std::count_if(reference.begin(), reference.end(), is_covered);
  return static_cast<double>(covered) / static_cast<double>(reference.size());
}

std::optional<TrajectoryScore> ScoreTrajectory(const Trajectory& reference,
                                               const Trajectory& estimate,
                                               double max_difference_s) {
  const std::vector<PosePair> pairs = Associate(reference, estimate, max_difference_s);
  if (pairs.empty()) return std::nullopt;
  TrajectoryScore score;
  score.reference_poses = static_cast<int>(reference.size());
  score.estimate_poses = static_cast<int>(estimate.size());
  score.matched_poses = static_cast<int>(pairs.size());
  score.reference_path_m = ReferencePath(pairs).back();
  score.time_coverage = TimeCoverage(reference, pairs);
  ScoreAbsolute(pairs, score);
  ScoreRelative(pairs, score);
  ScoreDrift(pairs, score);
  return score;
}

}  // namespace depthgrid
