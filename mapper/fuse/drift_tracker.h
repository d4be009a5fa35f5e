// The learning Kalman filter from frame to frame: the equations of drift_filter.h with the noise
// that MotionNoiseLearner finds.
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

  // SLAM's next pose comes so many frames after the last one committed: more than one where the
  // recording paused.
  void SetFrames(int frames) { frames_ = frames; }
  Prediction Predict(const Pose2& slam_from_base) const;
  FusedPose Fuse(const Pose2& slam_from_base, const MatchResult& match) const;
  // The pose that SLAM's newest was given. When it is not what Fuse() returns for the match, it was
  // set from outside and the filter starts from it.
  void Commit(const Pose2& slam_from_base, const Pose2& map_from_base,
              const Eigen::Matrix3d& covariance, const MatchResult& match);
  // SLAM's newest pose lies there, whatever came before: nothing of the bias is known. What was
  // learnt of SLAM's noise stays.
  void Restart(const Pose2& slam_from_base, const Pose2& map_from_base,
               const Eigen::Matrix3d& covariance);

  // How SLAM's motion errs, as an adjustment of all poses tells. What is learnt from the matches
  // alone is bounded by it: these are made against what the filter's own estimates drew, whose
  // wandering looks like SLAM's. Innovations that speak against the bound lift it.
  void BoundMotion(const MotionSpread& spread);
  // After Commit(): the innovation that it took, in base axes of the predicted pose, and the
  // inverse of its covariance as pose and map together tell it (PoseErrors). An old part of the
  // map, come back to, may be off by more than the filter knows: that does not speak against the
  // bound.
  void AddInnovation(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& weight) {
    map_evidence_.Add(innovation, weight);
  }
  // Before the first pose: what another has learnt of the same SLAM's noise, and the bound on it.
  void BeginWith(const DriftTracker& before, const MotionSpread& spread);

  // What the last Commit() did to the errors of pose and bias.
  const FilterStep& step() const { return step_; }

  const MotionNoise& noise() const { return noise_; }

 private:
  struct Last {
    Pose2 slam_from_base;
    std::optional<MatchResult> match;
  };
  DriftState AnewAt(const Pose2& map_from_base, const Eigen::Matrix3d& covariance) const;
  // So many frames' errors are in the motion to there: none where SLAM stands.
  int FramesTo(const Pose2& slam_from_base) const;
  DriftState StateAt(const Pose2& slam_from_base) const;
  FilterStep StepTo(const Pose2& slam_from_base, const Pose2& predicted) const;
  void Learn(const Pose2& motion, bool stands, const MatchResult& before, const MatchResult& now);
  bool ConfirmsItself(int axis) const;
  void BoundLearnt();  // by the spread, if that is known
  void TestBound(const Prediction& prediction, const MatchResult& match);
  void StartAnew();

  MotionNoise noise_;   // what the filter believes: caution included
  MotionNoise learnt_;  // without: what is told of the errors
  MotionNoiseLearner learner_;
  std::optional<MotionSpread> spread_;
  bool drifted_ = false;        // SLAM, more than it was taken to since the last adjustment
  DriftEvidence evidence_;      // against it, as the filter knows its errors,
  DriftEvidence map_evidence_;  // and as pose and map together are known
  int next_fit_ = 0;
  FilterStep step_;
  DriftState state_;
  std::optional<Last> last_;
  Standing standing_;
  int frames_ = 1;  // from it to the next pose
};

}  // namespace depthgrid
