#include "mapper/fuse/drift_tracker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

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
// Times what the adjusted poses say, which is too small: they are drawn towards the prior.
constexpr double kBoundSigmas = 3.5;
// Of the mean innovation. Neighbouring innovations are not independent: with a perfect prior 170
// was the most, with one that drifts by 4 cm it is above 1,000 (docs/results.md).
constexpr double kMostChi2 = 200.0;

}  // namespace

DriftTracker::DriftTracker() { StartAnew(); }

void DriftTracker::StartAnew() {
  learner_ = MotionNoiseLearner();
  noise_ = MotionNoise();
  noise_.walk = kFirstWalk;
  next_fit_ = kFirstFit;
  spread_.reset();
  evidence_ = DriftEvidence();
}

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
        if (spread_) TestBound(PredictionOf(predicted, noise_), match);
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
  Bound();
  next_fit_ = learner_.motions() + std::max(kFirstFit / 2, learner_.motions() / kFitGrowth);
}

void DriftTracker::BoundMotion(const MotionSpread& spread) {
  spread_ = spread;
  evidence_ = DriftEvidence();
  Bound();
}

// A bias sums up with the number of frames, a walk with its root.
void DriftTracker::Bound() {
  if (!spread_) return;
  const Eigen::Vector3d sigma = kBoundSigmas * spread_->sigma;
  noise_.bias = noise_.bias.cwiseMin(sigma);
  noise_.walk = noise_.walk.cwiseMin(std::sqrt(spread_->frames) * sigma);
}

// When SLAM begins to drift all that was learnt of it is wrong.
void DriftTracker::TestBound(const Prediction& prediction, const MatchResult& match) {
  evidence_.Add(InnovationOf(prediction.map_from_base, match.map_from_base),
                InnovationWeight(prediction, match.information));
  if (evidence_.Chi2() > kMostChi2) StartAnew();
}

}  // namespace depthgrid
