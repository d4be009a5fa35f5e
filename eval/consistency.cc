#include "eval/consistency.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "mapper/core/error.h"
#include "mapper/fuse/fusion.h"

namespace depthgrid {

int DirectionsSeen(const MatchResult& match) {
  constexpr double kUnseen = 1e-6;  // of the best seen direction
  // In units where a metre and a radian of a view 3 m deep weigh alike.
  const Eigen::Vector3d unit(1.0, 1.0, 1.0 / 3.0);
  const Eigen::Matrix3d information = unit.asDiagonal() * match.information * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(information, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d values = solver.eigenvalues();
  if (values[2] <= 0.0) return 0;
  return static_cast<int>((values.array() > kUnseen * values[2]).count());
}

std::vector<ChiSquareSample> InnovationSamples(const std::vector<FrameReport>& reports) {
  std::vector<ChiSquareSample> samples;
  for (const FrameReport& report : reports) {
    if (!report.match.found) continue;
    samples.push_back({report.innovation_chi2, DirectionsSeen(report.match)});
  }
  return samples;
}

std::vector<ChiSquareSample> RelativeMotionSamples(const std::vector<JudgedPose>& poses,
                                                   int frames) {
  Require(frames > 0, "a motion takes at least one frame");
  std::vector<ChiSquareSample> samples;
  const auto step = static_cast<std::size_t>(frames);
  for (std::size_t i = 0; i + step < poses.size(); i += step) {
    const JudgedPose& before = poses[i];
    const JudgedPose& after = poses[i + step];
    const Pose2 true_motion = Between(before.truth, after.truth);
    const Pose2 motion = Between(before.estimate, after.estimate);
    const Eigen::Vector3d error = Between(motion, true_motion).vector();
    const Eigen::Matrix3d covariance = Transported(before.covariance, motion) + after.covariance;
    const Eigen::LDLT<Eigen::Matrix3d> factor(covariance);
    if (!factor.isPositive() || (factor.vectorD().array() <= 0.0).any()) continue;
    samples.push_back({error.dot(factor.solve(error)), 3});
  }
  return samples;
}

}  // namespace depthgrid
