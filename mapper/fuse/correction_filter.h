// The mapper's state: the planar correction map_from_slam, carried from frame to frame and moved
// towards what matching observes (Eq. 3).
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

  // SLAM's next pose comes so many frames after the last one committed: more than one where the
  // recording paused. `learned`; the other modes count the time.
  void SetFrames(int frames) { tracker_.SetFrames(frames); }

  // Where SLAM's pose is in the map before matching. The pose must be of the epoch of the last one
  // committed: the difference of the two is taken as a motion.
  Prediction Predict(const Pose2& slam_from_base, double stamp_s) const;

  // Eq. 3 for the prediction of this pose. Without a match, the prediction. `outside_gain` is what
  // mode `oracle` takes.
  FusedPose Fuse(const Pose2& slam_from_base, const Prediction& prediction,
                 const MatchResult& match, const Eigen::Vector3d& outside_gain);

  // Makes the fused pose the state: correction := map_from_base * slam_from_base^-1. The correction
  // is left as it is, bit for bit, when the pose is where it already puts SLAM's.
  void Commit(const Pose2& slam_from_base, double stamp_s, const Pose2& map_from_base,
              const Eigen::Matrix3d& covariance);

  // SLAM's newest pose, of a new epoch or the run's first, lies there, known like this; as Commit()
  // otherwise.
  void Restart(const Pose2& slam_from_base, double stamp_s, const Pose2& map_from_base,
               const Eigen::Matrix3d& covariance);

  // The map was corrected: the last pose is now where this correction puts it.
  void SetCorrection(const Pose2& map_from_slam);

  // Mode `learned`, with poses whose differences are motions.
  bool Learns() const;
  // `learned`: how SLAM's motion errs, as an adjustment of all poses tells, and how the last match
  // was off for pose and map together (DriftTracker).
  void BoundMotion(const MotionSpread& spread) { tracker_.BoundMotion(spread); }
  void AddInnovation(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& weight) {
    if (Learns()) tracker_.AddInnovation(innovation, weight);
  }
  void BeginWith(const CorrectionFilter& before, const MotionSpread& spread) {
    tracker_.BeginWith(before.tracker_, spread);
  }

  // What the last Commit() did to the errors of pose and bias.
  const FilterStep& step() const { return Learns() ? tracker_.step() : step_; }

  const Pose2& map_from_slam() const { return map_from_slam_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  struct Last {
    Pose2 slam_from_base;
    double stamp_s = 0.0;
  };

  // Where SLAM's pose lies before the match: carried by the last correction, or as it is.
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
  // Of the last pose in its base axes; with an absolute prior that of SLAM's.
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  std::optional<Last> last_;
  // `learned`
  DriftTracker tracker_;
  MatchResult last_match_;  // that Fuse() took
  Eigen::Matrix3d last_gain_ = Eigen::Matrix3d::Zero();
  FilterStep step_;
  // `adaptive`
  std::array<double, 3> gain_;
  std::optional<Eigen::Vector3d> last_innovation_;
  Eigen::Vector3d innovation_power_ = Eigen::Vector3d::Zero();
};

}  // namespace depthgrid
