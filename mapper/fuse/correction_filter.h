// The mapper's state: the planar correction map_from_slam, carried from frame to frame and moved
// towards the matched poses (Eq. 3).
#pragma once

#include <array>
#include <optional>

#include "mapper/fuse/drift_tracker.h"
#include "mapper/fuse/filter_step.h"
#include "mapper/fuse/fusion.h"

namespace depthgrid {

class CorrectionFilter {
 public:
  explicit CorrectionFilter(const FusionOptions& options)
      : options_(options), gain_(options.gain) {}

  // Number of frames from the last committed pose to the next: more than one after a pause; and how
  // long a frame usually takes, s (0: not known). Used by mode `learned`; the others use the
  // stamps.
  void SetFrames(int frames, double usual_step_s) { tracker_.SetFrames(frames, usual_step_s); }

  // The pose in the map before matching. `slam_from_base` must be of the last committed pose's
  // epoch: their difference is taken as a motion.
  Prediction Predict(const Pose2& slam_from_base, double stamp_s) const;

  // Eq. 3 with the prediction of this pose. Returns the prediction if there is no match.
  // `outside_gain`: the gain in mode `oracle`.
  FusedPose Fuse(const Pose2& slam_from_base, const Prediction& prediction,
                 const MatchResult& match, const Eigen::Vector3d& outside_gain);

  // Makes the fused pose the state: correction := map_from_base * slam_from_base^-1. The correction
  // stays bit for bit the same when it already maps slam_from_base to this pose.
  void Commit(const Pose2& slam_from_base, double stamp_s, const Pose2& map_from_base,
              const Eigen::Matrix3d& covariance);

  // Like Commit() for the first pose of a run or epoch, whose place in the map and covariance are
  // given.
  void Restart(const Pose2& slam_from_base, double stamp_s, const Pose2& map_from_base,
               const Eigen::Matrix3d& covariance);

  // Sets the correction after the map was corrected; the last pose moves accordingly.
  void SetCorrection(const Pose2& map_from_slam);

  // Whether mode is `learned` with a relative prior.
  bool Learns() const { return options_.LearnsNoise(); }
  // Mode `learned` (see DriftTracker): SLAM's motion noise from an adjustment, and the last
  // innovation with its weight from the covariance of pose and map.
  void BoundMotion(const MotionSpread& spread) { tracker_.BoundMotion(spread); }
  void AddInnovation(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& weight) {
    if (Learns()) tracker_.AddInnovation(innovation, weight);
  }
  void BeginWith(const CorrectionFilter& before, const MotionSpread& spread) {
    tracker_.BeginWith(before.tracker_, spread);
  }

  // How the last Commit() propagated the errors of pose and bias.
  const FilterStep& step() const { return Learns() ? tracker_.step() : step_; }

  const Pose2& map_from_slam() const { return map_from_slam_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  struct Last {
    Pose2 slam_from_base;
    double stamp_s = 0.0;
  };

  // SLAM's pose in the map before the match: with the last correction, or uncorrected (absolute
  // prior).
  Pose2 PredictedPose(const Pose2& slam_from_base) const;
  // `humble`: the match, its information divided by `match_overconfidence`.
  FusedPose FuseByMode(const Pose2& slam_from_base, const Prediction& prediction,
                       const MatchResult& humble, const Eigen::Vector3d& outside_gain);
  void Place(const Pose2& slam_from_base, double stamp_s, const Pose2& map_from_base,
             const Eigen::Matrix3d& covariance);
  FilterStep StepTo(const Pose2& slam_from_base, double stamp_s) const;
  Eigen::Vector3d AdaptedGain(const Eigen::Vector3d& innovation);

  FusionOptions options_;
  Pose2 map_from_slam_;
  // Covariance of the last pose in its base axes; with an absolute prior that of SLAM's pose.
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  std::optional<Last> last_;
  // `learned`
  DriftTracker tracker_;
  MatchResult last_match_;  // used by the last Fuse()
  Eigen::Matrix3d last_gain_ = Eigen::Matrix3d::Zero();
  FilterStep step_;
  // `adaptive`
  std::array<double, 3> gain_;
  std::optional<Eigen::Vector3d> last_innovation_;
  Eigen::Vector3d innovation_power_ = Eigen::Vector3d::Zero();
};

}  // namespace depthgrid
