#include "eval/run/consistency.h"

#include <Eigen/Cholesky>
#include <map>

#include "mapper/core/level.h"
#include "mapper/fuse/fusion.h"

namespace depthgrid {

int DirectionsSeen(const MatchResult& match) {
  return static_cast<int>(SeenBasis(match.information).cols());
}

std::vector<ChiSquareSample> InnovationSamples(const std::vector<FrameReport>& reports) {
  std::vector<ChiSquareSample> samples;
  for (const FrameReport& report : reports) {
    if (!report.match.found) continue;
    samples.push_back({report.innovation_chi2, DirectionsSeen(report.match)});
  }
  return samples;
}

std::vector<ChiSquareSample> MotionSamples(const std::vector<FrameReport>& reports,
                                           const Trajectory& truth) {
  std::map<double, Pose2> true_at;
  for (const StampedPose& pose : truth) true_at[pose.stamp_s] = BaseOf(pose.world_from_camera);
  std::map<int, const FrameReport*> report_of_index;
  for (const FrameReport& report : reports) report_of_index[report.index] = &report;
  std::vector<ChiSquareSample> samples;
  for (std::size_t i = 0; i + 1 < reports.size(); ++i) {
    const FrameReport& after = reports[i];
    // A stretch is complete at the frame where the next one begins.
    if (after.motion_from < 0 || after.motion_from == after.index) continue;
    if (reports[i + 1].motion_from != after.index) continue;
    const FrameReport& before = *report_of_index.at(after.motion_from);
    const auto true_before = true_at.find(before.stamp_s);
    const auto true_after = true_at.find(after.stamp_s);
    if (true_before == true_at.end() || true_after == true_at.end()) continue;
    const Pose2 motion = Between(BaseOf(*before.map_from_camera), BaseOf(*after.map_from_camera));
    const Pose2 true_motion = Between(true_before->second, true_after->second);
    const Eigen::Vector3d error = Between(motion, true_motion).vector();
    const Eigen::LDLT<Eigen::Matrix3d> factor(after.motion_covariance);
    if (!factor.isPositive() || (factor.vectorD().array() <= 0.0).any()) continue;
    samples.push_back({error.dot(factor.solve(error)), 3});
  }
  return samples;
}

ConsistencyScores ScoreConsistency(const std::vector<FrameReport>& reports,
                                   const Trajectory& truth) {
  return {ConsistencyOf(InnovationSamples(reports)), ConsistencyOf(MotionSamples(reports, truth))};
}

}  // namespace depthgrid
