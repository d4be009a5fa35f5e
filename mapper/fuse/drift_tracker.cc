#include "mapper/fuse/drift_tracker.h"

#include <Eigen/LU>
#include <algorithm>

namespace depthgrid {
namespace {

// Until something is learnt matches are believed: a prior that drifts would drag the young map
// along, and what the first frames draw is never put right online.
const Eigen::Vector3d kFirstWalk(0.003, 0.003, 0.003);
// The filter takes the map for exact, but what is drawn at a pose carries the pose's error on.
// SLAM's motion is believed this much less than learnt, so that it does not drag the map along
// (docs/results.md, "Laser logs").
constexpr double kCaution = 1.4;
// Motions before the first look at the noise; later looks are a quarter of all frames apart.
constexpr int kFirstFit = 8;
constexpr int kFitGrowth = 4;
}  // namespace

DriftTracker::DriftTracker() : next_fit_(kFirstFit) { noise_.walk = kFirstWalk; }

DriftState DriftTracker::StateAt(const Pose2& slam_from_base) const {
  return Predicted(state_, Between(last_->slam_from_base, slam_from_base), noise_);
}

Prediction DriftTracker::Predict(const Pose2& slam_from_base) const {
  if (!last_) return {slam_from_base, Eigen::Matrix3d::Zero()};
  return PredictionOf(StateAt(slam_from_base), noise_);
}

FusedPose DriftTracker::Fuse(const Pose2& slam_from_base, const MatchResult& match) const {
  if (!last_) return FuseKalman(Predict(slam_from_base), match);
  return Updated(StateAt(slam_from_base), match, noise_).fused;
}

void DriftTracker::Commit(const Pose2& slam_from_base, const Pose2& map_from_base,
                          const Eigen::Matrix3d& covariance, const MatchResult& match) {
  DriftState next;
  next.map_from_base = map_from_base;
  next.covariance.topLeftCorner<3, 3>() = covariance;
  next.covariance.bottomRightCorner<3, 3>() = noise_.bias.cwiseProduct(noise_.bias).asDiagonal();
  std::optional<MatchResult> matched;
  if (last_) {
    const DriftState predicted = StateAt(slam_from_base);
    if (match.found) {
      const DriftUpdate update = Updated(predicted, match, noise_);
      if (update.fused.map_from_base == map_from_base) {
        next = update.state;
        matched = match;
      }
    } else if (PredictionOf(predicted, noise_).map_from_base == map_from_base) {
      next = predicted;
    }
  }
  if (matched && last_->match) {
    Learn(Between(last_->slam_from_base, slam_from_base), *last_->match, *matched);
  } else {
    learner_.Break();
  }
  state_ = next;
  last_ = Last{slam_from_base, matched};
}

void DriftTracker::Learn(const Pose2& motion, const MatchResult& before, const MatchResult& now) {
  learner_.AddMatches(motion, before, now);
  if (learner_.motions() < next_fit_) return;
  noise_ = learner_.Fit();
  noise_.walk *= kCaution;
  noise_.bias *= kCaution;
  next_fit_ = learner_.motions() + std::max(kFirstFit / 2, learner_.motions() / kFitGrowth);
}

}  // namespace depthgrid
