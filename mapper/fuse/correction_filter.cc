#include "mapper/fuse/correction_filter.h"

#include <algorithm>

namespace depthgrid {
namespace {

// Least gain of `adaptive`.
constexpr double kLeastAdaptiveGain = 0.02;

Eigen::Vector3d AsVector(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

}  // namespace

Pose2 CorrectionFilter::PredictedPose(const Pose2& slam_from_base) const {
  const bool relative = options_.prior == PriorMode::kRelative;
  return relative ? map_from_slam_ * slam_from_base : slam_from_base;
}

Prediction CorrectionFilter::Predict(const Pose2& slam_from_base, double stamp_s) const {
  if (Learns()) {
    Prediction prediction = tracker_.Predict(slam_from_base);
    // Placed anew for this very frame: no motion leads there.
    if (last_ && last_->stamp_s >= stamp_s) prediction.motion_covariance.reset();
    return prediction;
  }
  Prediction prediction{PredictedPose(slam_from_base), covariance_};
  if (!last_) return prediction;
  const Pose2 motion = Between(last_->slam_from_base, slam_from_base);
  prediction.covariance = Transported(covariance_, motion) +
                          SlamStepCovariance(options_.slam_noise, motion, stamp_s - last_->stamp_s);
  return prediction;
}

FusedPose CorrectionFilter::Fuse(const Pose2& slam_from_base, const Prediction& prediction,
                                 const MatchResult& match, const Eigen::Vector3d& outside_gain) {
  FusedPose unmatched;
  unmatched.map_from_base = prediction.map_from_base;
  unmatched.covariance = prediction.covariance;
  last_match_ = MatchResult{};
  last_gain_.setZero();
  if (!match.found) return unmatched;
  MatchResult humble = match;
  humble.information /= options_.match_overconfidence;
  const Eigen::Vector3d innovation = InnovationOf(prediction.map_from_base, match.map_from_base);
  const double chi2 = InnovationChi2(prediction, humble.information, innovation);
  if (options_.gate_chi2 > 0.0 && chi2 > options_.gate_chi2) {
    unmatched.innovation = innovation;
    unmatched.innovation_chi2 = chi2;
    unmatched.rejected = true;
    return unmatched;
  }
  FusedPose fused = FuseByMode(slam_from_base, prediction, humble, outside_gain);
  fused.innovation_chi2 = chi2;
  last_gain_ = fused.gain * SeenInverse(humble.information) * humble.information;
  return fused;
}

FusedPose CorrectionFilter::FuseByMode(const Pose2& slam_from_base, const Prediction& prediction,
                                       const MatchResult& humble,
                                       const Eigen::Vector3d& outside_gain) {
  const Eigen::Vector3d innovation = InnovationOf(prediction.map_from_base, humble.map_from_base);
  switch (options_.mode) {
    case FusionMode::kLearned:
      last_match_ = humble;
      return Learns() ? tracker_.Fuse(slam_from_base, humble) : FuseKalman(prediction, humble);
    case FusionMode::kKalman:
      return FuseKalman(prediction, humble);
    case FusionMode::kAdaptive:
      return FuseWithGain(prediction, humble, AdaptedGain(innovation));
    case FusionMode::kOracle:
      return FuseWithGain(prediction, humble, outside_gain);
    case FusionMode::kFixed:
      break;
  }
  return FuseWithGain(prediction, humble, AsVector(options_.gain));
}

// With the best constant gain the innovations are white (Mehra 1970): two in a row of one sign say
// that too little was taken, of opposite sign too much. A step of Robbins and Monro on their
// normalised product finds that gain.
Eigen::Vector3d CorrectionFilter::AdaptedGain(const Eigen::Vector3d& innovation) {
  const double rate = options_.adaptive_rate;
  for (int axis = 0; axis < 3; ++axis) {
    const double square = innovation[axis] * innovation[axis];
    double& power = innovation_power_[axis];
    power = power == 0.0 ? square : power + rate * (square - power);
    if (!last_innovation_ || power == 0.0) continue;
    const double correlation =
        std::clamp((*last_innovation_)[axis] * innovation[axis] / power, -1.0, 1.0);
    double& gain = gain_[static_cast<std::size_t>(axis)];
    gain = std::clamp(gain + rate * correlation, kLeastAdaptiveGain, 1.0);
  }
  last_innovation_ = innovation;
  return AsVector(gain_);
}

// Here the filter's state is the reported pose itself.
FilterStep CorrectionFilter::StepTo(const Pose2& slam_from_base, double stamp_s) const {
  FilterStep step;
  step.predicted = PredictedPose(slam_from_base);
  if (!last_) return step;
  const Pose2 motion = Between(last_->slam_from_base, slam_from_base);
  step.walk = SlamStepCovariance(options_.slam_noise, motion, stamp_s - last_->stamp_s)
                  .diagonal()
                  .cwiseSqrt();
  step.gain = last_gain_;
  step.state_gain.topRows<3>() = last_gain_;
  step.previous = step.predicted * Inverse(motion);
  step.previous_gain = AdjointOf(motion) * last_gain_;
  return step;
}

void CorrectionFilter::Place(const Pose2& slam_from_base, double stamp_s,
                             const Pose2& map_from_base, const Eigen::Matrix3d& covariance) {
  step_ = StepTo(slam_from_base, stamp_s);
  last_gain_.setZero();
  if (!(map_from_slam_ * slam_from_base == map_from_base)) {
    map_from_slam_ = map_from_base * Inverse(slam_from_base);
  }
  covariance_ = covariance;
  last_ = Last{slam_from_base, stamp_s};
}

void CorrectionFilter::Commit(const Pose2& slam_from_base, double stamp_s,
                              const Pose2& map_from_base, const Eigen::Matrix3d& covariance) {
  // With an absolute prior the next prediction does not depend on this fused pose.
  const bool relative = options_.prior == PriorMode::kRelative;
  Place(slam_from_base, stamp_s, map_from_base,
        relative ? covariance : Predict(slam_from_base, stamp_s).covariance);
  if (Learns()) tracker_.Commit(slam_from_base, map_from_base, covariance, last_match_);
  last_match_ = MatchResult{};
}

void CorrectionFilter::Restart(const Pose2& slam_from_base, double stamp_s,
                               const Pose2& map_from_base, const Eigen::Matrix3d& covariance) {
  Place(slam_from_base, stamp_s, map_from_base, covariance);
  if (Learns()) tracker_.Restart(slam_from_base, map_from_base, covariance);
  last_match_ = MatchResult{};
}

void CorrectionFilter::SetCorrection(const Pose2& map_from_slam) {
  map_from_slam_ = map_from_slam;
  if (Learns() && last_) {
    tracker_.Restart(last_->slam_from_base, map_from_slam * last_->slam_from_base, covariance_);
  }
}

}  // namespace depthgrid
