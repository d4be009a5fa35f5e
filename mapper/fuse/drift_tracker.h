// Mode `learned`: the filter of drift_filter.h with the noise found by MotionNoiseLearner.
#pragma once

#include <optional>

#include "mapper/core/standing.h"
#include "mapper/fuse/drift_evidence.h"
#include "mapper/fuse/drift_filter.h"
#include "mapper/fuse/filter_step.h"
#include "mapper/fuse/motion_noise.h"

namespace depthgrid {

class DriftTracker {
 public:
  DriftTracker();

  // Number of frames from the last committed pose to the next: more than one after a pause; and how
  // long a frame usually takes, s (0: not known).
  void SetFrames(int frames, double usual_step_s);
  Prediction Predict(const Pose2& slam_from_base) const;
  FusedPose Fuse(const Pose2& slam_from_base, const MatchResult& match) const;
  // Takes the fused pose as state. If it is not what Fuse() returns for the match, it was set from
  // outside and the filter restarts from it.
  void Commit(const Pose2& slam_from_base, const Pose2& map_from_base,
              const Eigen::Matrix3d& covariance, const MatchResult& match);
  // Restarts at the given pose with unknown bias. What was learnt of SLAM's noise stays.
  void Restart(const Pose2& slam_from_base, const Pose2& map_from_base,
               const Eigen::Matrix3d& covariance);

  // Bounds the learnt noise by SLAM's motion noise from an adjustment of all poses. The matches
  // alone are no independent evidence, as the map was drawn at the filter's own estimates, whose
  // wandering looks like SLAM's. Contradicting innovations remove the bound.
  void BoundMotion(const MotionSpread& spread);
  // Call after Commit(): its innovation, in base axes of the predicted pose, and the inverse of its
  // covariance with the map's errors included (PoseErrors). The filter ignores these; a revisited
  // old part of the map may be off by more, which does not contradict the bound.
  void AddInnovation(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& weight) {
    map_evidence_.Add(innovation, weight);
  }
  // Call before the first pose: takes what another tracker learnt of the same SLAM, and the bound.
  void BeginWith(const DriftTracker& before, const MotionSpread& spread);

  // How the last Commit() propagated the errors of pose and bias.
  const FilterStep& step() const { return step_; }

  const MotionNoise& noise() const { return noise_; }

 private:
  struct Last {
    Pose2 slam_from_base;
    std::optional<MatchResult> match;
  };
  DriftState AnewAt(const Pose2& map_from_base, const Eigen::Matrix3d& covariance) const;
  // Number of frames whose errors the motion to there contains: 0 where SLAM stands.
  int FramesTo(const Pose2& slam_from_base) const;
  DriftState StateAt(const Pose2& slam_from_base) const;
  FilterStep StepTo(const Pose2& slam_from_base, const Pose2& predicted) const;
  void Learn(const Pose2& motion, bool stands, const MatchResult& before, const MatchResult& now);
  bool ConfirmsItself(int axis) const;
  Eigen::Vector3d FirstWalk() const;
  MotionNoise FirstNoise() const;
  void BoundLearnt();  // by the spread, if known
  void TestBound(const Prediction& prediction, const MatchResult& match);
  void StartAnew();

  MotionNoise noise_;   // used by the filter, caution included
  MotionNoise learnt_;  // without caution: used for reported errors
  MotionNoiseLearner learner_;
  std::optional<MotionSpread> spread_;
  bool drifted_ = false;        // SLAM drifts more than was assumed; until the next adjustment
  DriftEvidence evidence_;      // against the bound, by the filter's covariance
  DriftEvidence map_evidence_;  // and by that of pose and map together
  int next_fit_ = 0;
  FilterStep step_;
  DriftState state_;
  std::optional<Last> last_;
  Standing standing_;
  int frames_ = 1;             // from last_ to the next pose
  double walk_growth_ = 1.0;   // of the first walk in long frames
  bool knows_nothing_ = true;  // of SLAM's noise
};

}  // namespace depthgrid
