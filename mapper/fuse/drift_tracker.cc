#include "mapper/fuse/drift_tracker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// Walk assumed before anything is learnt, large so that matches dominate: SLAM that drifts would
// distort the young map, which is not corrected online.
const Eigen::Vector3d kFirstWalk(0.003, 0.003, 0.003);
// That is for frames up to this long, those of a camera at 30 Hz among them. It grows with the root
// of longer ones, as a walk does (docs/tried.md, "A recorded laser log"), up to ten times as long.
constexpr double kFirstWalkStepS = 0.035;
constexpr double kMostSteps = 10.0;
// Matches alone confirm any belief about SLAM (a map that follows SLAM agrees with it). So the
// filter's walk is at least this share of the first walk along an axis, for this many observed
// motions, and again after SLAM was found to drift until the next adjustment.
constexpr int kUnconfirmedMotions = 1000;
constexpr double kLeastOfFirstWalk = 0.5;
// With that limit it does not confirm itself, so reported errors use the learnt noise without limit
// once this many motions were observed (docs/tried.md, "Consistency"), unless SLAM drifted.
constexpr int kTellingMotions = 50;
// Factor on the learnt walk and bias in the filter, which takes the map as exact although it
// inherits the errors of the poses it was drawn at (docs/tried.md, "Settings on laser logs").
// Reported errors include the map's instead (PoseErrors).
constexpr double kCaution = 1.4;
// Motions before the first fit of the noise; later fits come after a quarter more motions.
constexpr int kFirstFit = 8;
constexpr int kFitGrowth = 4;
// Motions over more frames are not used for learning: a few frames may be missing, but no pause.
constexpr int kMostLearntFrames = 3;
// Limit on DriftEvidence::Chi2(). Neighbouring innovations are correlated: at most 170 with perfect
// SLAM, above 1,000 with one that drifts by 4 cm (docs/tried.md).
constexpr double kMostChi2 = 200.0;
// The same with the covariance of pose and map, which is more realistic: at most 31 with perfect
// SLAM (docs/tried.md, "A nearly perfect prior").
constexpr double kMostMapChi2 = 60.0;

}  // namespace

DriftTracker::DriftTracker() { StartAnew(); }

Eigen::Vector3d DriftTracker::FirstWalk() const { return walk_growth_ * kFirstWalk; }

MotionNoise DriftTracker::FirstNoise() const {
  MotionNoise noise;
  noise.walk = FirstWalk();
  return noise;
}

void DriftTracker::SetFrames(int frames, double usual_step_s) {
  frames_ = frames;
  walk_growth_ = std::sqrt(std::clamp(usual_step_s / kFirstWalkStepS, 1.0, kMostSteps));
  if (knows_nothing_) learnt_ = noise_ = FirstNoise();
}

void DriftTracker::StartAnew() {
  learner_ = MotionNoiseLearner();
  learnt_ = FirstNoise();
  noise_ = learnt_;
  knows_nothing_ = true;
  next_fit_ = kFirstFit;
  spread_.reset();
  evidence_ = DriftEvidence();
  map_evidence_ = DriftEvidence();
}

int DriftTracker::FramesTo(const Pose2& slam_from_base) const {
  const bool stands = frames_ <= kMostLearntFrames &&
                      standing_.After(Between(last_->slam_from_base, slam_from_base));
  return stands ? 0 : frames_;
}

DriftState DriftTracker::StateAt(const Pose2& slam_from_base) const {
  return Predicted(state_, Between(last_->slam_from_base, slam_from_base), FramesTo(slam_from_base),
                   noise_);
}

Prediction DriftTracker::Predict(const Pose2& slam_from_base) const {
  if (!last_) return {slam_from_base, Eigen::Matrix3d::Zero()};
  Prediction prediction = PredictionOf(StateAt(slam_from_base), noise_);
  if (frames_ > kMostLearntFrames) prediction.motion_covariance.reset();
  return prediction;
}

FusedPose DriftTracker::Fuse(const Pose2& slam_from_base, const MatchResult& match) const {
  if (!last_) return FuseKalman(Predict(slam_from_base), match);
  return Updated(StateAt(slam_from_base), match, noise_).fused;
}

FilterStep DriftTracker::StepTo(const Pose2& slam_from_base, const Pose2& predicted) const {
  FilterStep step;
  step.predicted = predicted;
  if (!last_) return step;
  const MotionErrors errors = ErrorsOver(FramesTo(slam_from_base), learnt_);
  step.walk = errors.walk;
  step.jitter = learnt_.jitter;
  step.bias_added = errors.bias_added;
  step.bias_kept = errors.bias_kept;
  step.bias_renewed = errors.bias_renewed;
  return step;
}

DriftState DriftTracker::AnewAt(const Pose2& map_from_base,
                                const Eigen::Matrix3d& covariance) const {
  DriftState state;
  state.map_from_base = map_from_base;
  state.covariance.topLeftCorner<3, 3>() = covariance;
  state.covariance.bottomRightCorner<3, 3>() = Squared(noise_.bias);
  return state;
}

void DriftTracker::Restart(const Pose2& slam_from_base, const Pose2& map_from_base,
                           const Eigen::Matrix3d& covariance) {
  step_ = StepTo(slam_from_base, map_from_base);
  step_.new_bias = learnt_.bias;
  state_ = AnewAt(map_from_base, covariance);
  last_ = Last{slam_from_base, {}};
  frames_ = 1;
  standing_.MapMoved();
  learner_.Break();
}

void DriftTracker::Commit(const Pose2& slam_from_base, const Pose2& map_from_base,
                          const Eigen::Matrix3d& covariance, const MatchResult& match) {
  DriftState next = AnewAt(map_from_base, covariance);
  std::optional<MatchResult> matched;
  step_ = StepTo(slam_from_base, map_from_base);
  step_.new_bias = learnt_.bias;
  if (last_) {
    const DriftState predicted = StateAt(slam_from_base);
    step_.predicted = predicted.map_from_base;
    if (match.found) {
      const DriftUpdate update = Updated(predicted, match, noise_);
      if (update.fused.map_from_base == map_from_base) {
        next = update.state;
        step_.gain = update.fused.gain;
        step_.state_gain = update.gain;
        step_.previous = state_.map_from_base;
        step_.previous_gain = update.previous_gain;
        step_.new_bias.reset();
        if (!match.left_out_misfits) matched = match;
        if (spread_) TestBound(PredictionOf(predicted, noise_), match);
      }
    } else if (PredictionOf(predicted, noise_).map_from_base == map_from_base) {
      next = predicted;
      step_.new_bias.reset();
    }
  }
  const bool follows = matched && last_->match && frames_ <= kMostLearntFrames;
  if (!follows) learner_.Break();
  if (last_) {
    const Pose2 motion = Between(last_->slam_from_base, slam_from_base);
    if (follows) Learn(motion, FramesTo(slam_from_base) == 0, *last_->match, *matched);
    standing_.Add(motion, match.found ? std::optional(match.map_from_base) : std::nullopt);
  }
  state_ = next;
  last_ = Last{slam_from_base, matched};
  frames_ = 1;
}

void DriftTracker::Learn(const Pose2& motion, bool stands, const MatchResult& before,
                         const MatchResult& now) {
  learner_.AddMatches(motion, stands, before, now);
  if (learner_.motions() < next_fit_) return;
  knows_nothing_ = false;
  learnt_ = learner_.Fit(FirstNoise());
  noise_ = learnt_;
  noise_.walk *= kCaution;
  noise_.bias *= kCaution;
  BoundLearnt();
  for (int axis = 0; axis < 3; ++axis) {
    if (!ConfirmsItself(axis)) continue;
    const int seen = learner_.seen()[static_cast<std::size_t>(axis)];
    const double least = kLeastOfFirstWalk * FirstWalk()[axis];
    if (drifted_ || seen < kUnconfirmedMotions) {
      noise_.walk[axis] = std::max(noise_.walk[axis], least);
    }
    if (drifted_ || seen < kTellingMotions) {
      learnt_.walk[axis] = std::max(learnt_.walk[axis], least);
    }
  }
  next_fit_ = learner_.motions() + std::max(kFirstFit / 2, learner_.motions() / kFitGrowth);
}

// Whether SLAM's noise along an axis is known from matches alone, or the adjustment's estimate is
// unsure and above the first walk: beside a lone wall, matches would soon agree with SLAM.
bool DriftTracker::ConfirmsItself(int axis) const {
  if (!spread_) return true;
  if (spread_->IsSure()) return false;
  return !spread_->Tells(axis) ||
         std::sqrt(spread_->frames) * spread_->sigma[axis] > FirstWalk()[axis];
}

void DriftTracker::BoundMotion(const MotionSpread& spread) {
  knows_nothing_ = false;
  spread_ = spread;
  drifted_ = false;
  evidence_ = DriftEvidence();
  map_evidence_ = DriftEvidence();
  BoundLearnt();
}

void DriftTracker::BeginWith(const DriftTracker& before, const MotionSpread& spread) {
  noise_ = before.noise_;
  learnt_ = before.learnt_;
  BoundMotion(spread);
}

// If SLAM is trusted, the map follows it and matches against that map agree; if matches are
// trusted, the map wanders with them (docs/tried.md, "Laser logs").
void DriftTracker::BoundLearnt() {
  if (!spread_) return;
  Bound(*spread_, noise_);
  Bound(*spread_, learnt_);
}

// Forgets all that was learnt if SLAM drifts more than the bound allows.
void DriftTracker::TestBound(const Prediction& prediction, const MatchResult& match) {
  evidence_.Add(InnovationOf(prediction.map_from_base, match.map_from_base),
                InnovationWeight(prediction, match.information));
  if (evidence_.Chi2() <= kMostChi2 || map_evidence_.Chi2() <= kMostMapChi2) return;
  StartAnew();
  drifted_ = true;
}

}  // namespace depthgrid
