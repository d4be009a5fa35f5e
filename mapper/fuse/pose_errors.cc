#include "mapper/fuse/pose_errors.h"

#include <algorithm>
#include <limits>

#include "mapper/core/error.h"
#include "mapper/core/symmetric_eigen.h"
#include "mapper/fuse/fusion.h"

namespace depthgrid {
namespace {

// Age, in frames, below which knots are not kept any denser.
constexpr double kNewestAge = 8.0;
// Correlation time of the noise of the map in view, as a share of the map's mean age; measured
// (docs/tried.md, "Laser logs").
constexpr double kNoiseAge = 0.4;
// Sigmas of a depth camera's lasting error where matches claim to be exact: forward and left (m),
// yaw (rad). Measured with five sensors in two rooms (docs/tried.md, "Errors that last").
constexpr std::array<double, 3> kLeastLasting = {0.0003, 0.0003, 0.0002};

Eigen::Matrix3d Turned(const Eigen::Matrix3d& covariance, const Eigen::Matrix3d& adjoint) {
  return adjoint * covariance * adjoint.transpose();
}

// Mean age of the map in view, frames.
double AgeOf(std::span<const MapPart> parts, int mapped) {
  double sum = 0.0;
  double weight = 0.0;
  for (const MapPart& part : parts) {
    const double w = part.information.topLeftCorner<2, 2>().trace();
    sum += w * (mapped - part.mapped);
    weight += w;
  }
  return weight > 0.0 ? std::max(sum / weight, 0.0) : 0.0;
}

// Share of the map's noise in the match's variance.
double ShareOfMapNoise(std::span<const MapPart> parts) {
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d noisy = Eigen::Matrix3d::Zero();
  for (const MapPart& part : parts) {
    all += part.information;
    noisy += part.noise_share * part.information;
  }
  return std::clamp((SeenInverse(all) * noisy).trace() / 3.0, 0.0, 1.0);
}

}  // namespace

LastingError LastingErrorOfCamera(double share) {
  if (share <= 0.0) return {};
  return {share, Eigen::Vector3d(kLeastLasting.data())};
}

PoseErrors::PoseErrors(int stretch_frames) : stretch_frames_(stretch_frames) {
  knots_with_newest_.setZero();
  covariance_.setZero();
  share_.fill(Eigen::Matrix3d::Zero());
  knots_.reserve(kKnots);
  shared_.reserve(kKnots);
}

std::vector<int> PoseErrors::Mapped() const {
  std::vector<int> mapped;
  for (const Knot& knot : knots_) mapped.push_back(knot.mapped);
  return mapped;
}

Eigen::Matrix3d PoseErrors::OriginFromBase(const Pose2& map_from_base) const {
  return AdjointOf(Between(origin_, map_from_base));
}

Eigen::Matrix3d PoseErrors::BaseFromOrigin(const Pose2& map_from_base) const {
  return AdjointOf(Between(map_from_base, origin_));
}

void PoseErrors::Adjusted(const Eigen::MatrixXd& covariance,
                          const std::optional<Eigen::Vector3d>& bias) {
  if (covariance.size() == 0) return;
  Require(covariance.rows() == 3 * static_cast<Eigen::Index>(knots_.size()),
          "an adjustment tells the errors of the remembered frames");
  const Eigen::Matrix3d origin_from_map = AdjointOf(Inverse(origin_));
  const auto told = [&](std::size_t row, std::size_t column) -> Eigen::Matrix3d {
    return origin_from_map *
           covariance.block<3, 3>(3 * static_cast<Eigen::Index>(row),
                                  3 * static_cast<Eigen::Index>(column)) *
           origin_from_map.transpose();
  };
  const std::size_t last = knots_.size() - 1;
  const Eigen::Matrix3d map_noise = newest_.block<3, 3>(kMapNoise, kMapNoise);
  const Eigen::Matrix3d old_bias = newest_.block<3, 3>(kBias, kBias);
  newest_.setZero();
  knots_with_newest_.setZero();
  for (const int row : {kPose, kCamera}) {
    for (const int column : {kPose, kCamera}) {
      newest_.block<3, 3>(row, column) = told(last, last);
    }
  }
  newest_.block<3, 3>(kMapNoise, kMapNoise) = map_noise;
  newest_.block<3, 3>(kBias, kBias) = bias ? Eigen::Matrix3d(Squared(*bias)) : old_bias;
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    for (const int column : {kPose, kCamera}) {
      knots_with_newest_.block<3, 3>(3 * knots_[i].slot, column) = told(i, last);
    }
    for (std::size_t k = 0; k < knots_.size(); ++k) {
      covariance_.block<3, 3>(3 * knots_[i].slot, 3 * knots_[k].slot) = told(i, k);
    }
  }
}

void PoseErrors::Add(const FilterStep& step, int index, int mapped,
                     const Eigen::Matrix3d& information, std::span<const MapPart> parts,
                     const LastingError& lasting) {
  ++frame_;
  innovation_.reset();
  if (knots_.empty()) {
    origin_ = {step.predicted.x_m, step.predicted.y_m, 0.0};
  } else {
    if (knots_.back().frame - knots_[marked_].frame >= stretch_frames_) marked_ = knots_.size() - 1;
    Predict(step, parts);
    Take(step, See(step, information, parts, lasting));
    if (parts.empty()) innovation_.reset();
  }
  Keep(index, mapped);
  if (broken_) marked_ = knots_.size() - 1;
  broken_ = false;
}

// Propagates through SLAM's motion: the bias, which is in base axes, adds to the pose.
void PoseErrors::Predict(const FilterStep& step, std::span<const MapPart> parts) {
  const Eigen::Matrix3d origin_from_step = OriginFromBase(step.predicted);
  const double noise_kept = 1.0 - 1.0 / (1.0 + kNoiseAge * AgeOf(parts, knots_.back().mapped + 1));
  Matrix9 f = Matrix9::Identity();
  const Eigen::Matrix3d origin_from_bias = origin_from_step * step.bias_added.asDiagonal();
  f.block<3, 3>(kPose, kBias) = origin_from_bias;
  f.block<3, 3>(kBias, kBias) = step.bias_kept.asDiagonal();
  f.block<3, 3>(kMapNoise, kMapNoise) *= noise_kept;
  Matrix9 state = f * newest_.topLeftCorner<9, 9>() * f.transpose();
  state.block<3, 3>(kPose, kPose) += Turned(Squared(step.walk), origin_from_step);
  state.block<3, 3>(kBias, kBias) += Squared(step.bias_renewed);
  auto knots_with_bias = knots_with_newest_.middleCols<3>(kBias);
  knots_with_newest_.middleCols<3>(kPose).noalias() +=
      knots_with_bias * origin_from_bias.transpose();
  knots_with_bias = (knots_with_bias * step.bias_kept.asDiagonal()).eval();
  knots_with_newest_.middleCols<3>(kMapNoise) *= noise_kept;
  newest_.topLeftCorner<9, 9>() = state;
  if (step.new_bias) RenewBias(*step.new_bias);
}

void PoseErrors::RenewBias(const Eigen::Vector3d& bias) {
  newest_.middleRows<3>(kBias).setZero();
  newest_.middleCols<3>(kBias).setZero();
  newest_.block<3, 3>(kBias, kBias) = Squared(bias);
  knots_with_newest_.middleCols<3>(kBias).setZero();
}

void PoseErrors::BeginEpoch(const Pose2& map_from_base, const Eigen::Matrix3d& added,
                            const std::optional<Eigen::Vector3d>& bias) {
  Break();
  if (knots_.empty()) return;
  newest_.block<3, 3>(kPose, kPose) += Turned(added, OriginFromBase(map_from_base));
  if (bias) RenewBias(*bias);
}

// Slot of the knot nearest to mapped frame `mapped`; -1 for parts drawn before the first knot.
int PoseErrors::SlotOf(double mapped) const {
  if (mapped < knots_.front().mapped) return -1;
  const auto after = std::lower_bound(knots_.begin(), knots_.end(), mapped,
                                      [](const Knot& knot, double m) { return knot.mapped < m; });
  if (after == knots_.end()) return knots_.back().slot;
  if (after == knots_.begin()) return after->slot;
  const auto before = after - 1;
  return mapped - before->mapped < after->mapped - mapped ? before->slot : after->slot;
}

// A match's error is the information-weighted mean of the errors of the matched parts: error = (sum
// H_k)^-1 sum H_k error_k, in axes of the origin.
void PoseErrors::Weigh(std::span<const MapPart> parts, const Pose2& map_from_base) {
  for (const int slot : shared_) share_[static_cast<std::size_t>(slot)].setZero();
  shared_.clear();
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  for (const MapPart& part : parts) {
    all += part.information;
    const int slot = SlotOf(part.mapped);
    if (slot < 0) continue;
    if (std::find(shared_.begin(), shared_.end(), slot) == shared_.end()) shared_.push_back(slot);
    share_[static_cast<std::size_t>(slot)] += part.information;
  }
  const Eigen::Matrix3d mean = OriginFromBase(map_from_base) * SeenInverse(all);
  const Eigen::Matrix3d step_from_origin = BaseFromOrigin(map_from_base);
  for (const int slot : shared_) {
    Eigen::Matrix3d& share = share_[static_cast<std::size_t>(slot)];
    share = (mean * share * step_from_origin).eval();
  }
}

// A match's error has four parts: the errors of the frames that drew the map there; that surface's
// own noise and the scan's lasting error, which persist together while it is in view; and the
// scan's noise, which is independent.
PoseErrors::MatchError PoseErrors::See(const FilterStep& step, const Eigen::Matrix3d& information,
                                       std::span<const MapPart> parts,
                                       const LastingError& lasting) {
  MatchError match{Eigen::Matrix3d::Zero(), Matrix93::Zero()};
  knots_with_match_.setZero();
  if (parts.empty()) return match;
  Weigh(parts, step.predicted);
  const double noise_share = ShareOfMapNoise(parts);
  const Eigen::Matrix3d origin_from_step = OriginFromBase(step.predicted);
  const Eigen::Matrix3d noise = Turned(SeenInverse(information), origin_from_step);
  const Eigen::Matrix3d lasts =
      (noise_share + lasting.share) * noise + Turned(Squared(lasting.least), origin_from_step);
  auto map_noise = newest_.block<3, 3>(kMapNoise, kMapNoise);
  map_noise += WithEigenvaluesAtLeast(lasts - map_noise, 0.0);
  for (const int slot : shared_) {
    const Eigen::Matrix3d& share = share_[static_cast<std::size_t>(slot)];
    knots_with_match_.noalias() += covariance_.middleCols<3>(3 * slot) * share.transpose();
    match.with_state.noalias() +=
        knots_with_newest_.block<3, 9>(3 * slot, 0).transpose() * share.transpose();
  }
  for (const int slot : shared_) {
    match.covariance.noalias() += knots_with_match_.middleRows<3>(3 * slot).transpose() *
                                  share_[static_cast<std::size_t>(slot)].transpose();
  }
  const Eigen::Matrix3d noise_with_map = match.with_state.middleRows<3>(kMapNoise);
  match.covariance +=
      noise_with_map + noise_with_map.transpose() + map_noise + (1.0 - noise_share) * noise;
  match.with_state += newest_.block<9, 3>(0, kMapNoise);
  knots_with_match_ += knots_with_newest_.middleCols<3>(kMapNoise);
  return match;
}

// With i = pose + jitter - match the error of the innovation: state -= G i, camera = pose + jitter
// - K i.
void PoseErrors::Take(const FilterStep& step, const MatchError& match) {
  const Eigen::Matrix3d origin_from_step = OriginFromBase(step.predicted);
  const Eigen::Matrix3d step_from_origin = BaseFromOrigin(step.predicted);
  const Eigen::Matrix3d k = origin_from_step * step.gain * step_from_origin;
  Matrix93 g = Matrix93::Zero();
  g.middleRows<3>(kPose) = origin_from_step * step.state_gain.topRows<3>() * step_from_origin;
  g.middleRows<3>(kBias) = step.state_gain.bottomRows<3>() * step_from_origin;
  const Matrix9 state = newest_.topLeftCorner<9, 9>();
  const Eigen::Matrix3d camera =
      state.block<3, 3>(kPose, kPose) + Turned(Squared(step.jitter), origin_from_step);
  const Eigen::Matrix3d pose_with_match = match.with_state.middleRows<3>(kPose);
  const Eigen::Matrix3d camera_with_i = camera - pose_with_match;
  const Eigen::Matrix3d i = camera_with_i - pose_with_match.transpose() + match.covariance;
  innovation_ = Turned(i, step_from_origin);
  const Matrix93 state_with_i = state.middleCols<3>(kPose) - match.with_state;

  const Matrix9 taken = g * state_with_i.transpose();
  newest_.topLeftCorner<9, 9>() = state - taken - taken.transpose() + g * i * g.transpose();
  const Eigen::Matrix3d moved = k * camera_with_i.transpose();
  newest_.block<3, 3>(kCamera, kCamera) =
      camera - moved - moved.transpose() + k * i * k.transpose();
  const Matrix93 state_with_camera = state.middleCols<3>(kPose) - state_with_i * k.transpose() -
                                     g * camera_with_i.transpose() + g * i * k.transpose();
  newest_.block<9, 3>(0, kCamera) = state_with_camera;
  newest_.block<3, 9>(kCamera, 0) = state_with_camera.transpose();
  // Asymmetry from rounding would grow from frame to frame.
  newest_ = (0.5 * (newest_ + newest_.transpose())).eval();

  const KnotsWith knots_with_pose = knots_with_newest_.middleCols<3>(kPose);
  const KnotsWith knots_with_i = knots_with_pose - knots_with_match_;
  knots_with_newest_.leftCols<6>().noalias() -= knots_with_i * g.topRows<6>().transpose();
  knots_with_newest_.middleCols<3>(kCamera) = knots_with_pose;
  knots_with_newest_.middleCols<3>(kCamera).noalias() -= knots_with_i * k.transpose();
}

// The knot to drop: the one whose neighbours are closest together relative to its age.
std::size_t PoseErrors::Spare() const {
  std::size_t spare = 1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
    if (i == marked_) continue;
    const double worth =
        (knots_[i + 1].frame - knots_[i - 1].frame) / (frame_ - knots_[i].frame + kNewestAge);
    if (worth < least) {
      least = worth;
      spare = i;
    }
  }
  return spare;
}

void PoseErrors::Keep(int index, int mapped) {
  int slot = static_cast<int>(knots_.size());
  if (slot == kKnots) {
    const std::size_t spare = Spare();
    slot = knots_[spare].slot;
    knots_.erase(knots_.begin() + static_cast<std::ptrdiff_t>(spare));
    if (spare < marked_) --marked_;
  }
  knots_with_newest_.middleRows<3>(3 * slot) = newest_.middleRows<3>(kCamera);
  const KnotsWith camera = knots_with_newest_.middleCols<3>(kCamera);
  covariance_.middleCols<3>(3 * slot) = camera;
  covariance_.middleRows<3>(3 * slot) = camera.transpose();
  knots_.push_back({frame_, index, mapped, slot});
}

Eigen::Matrix3d PoseErrors::MotionCovariance(const Pose2& map_from_base) const {
  Require(!knots_.empty(), "a motion takes a frame");
  const int slot = 3 * knots_[marked_].slot;
  const Eigen::Matrix3d cross = knots_with_newest_.block<3, 3>(slot, kCamera);
  const Eigen::Matrix3d both = newest_.block<3, 3>(kCamera, kCamera) +
                               covariance_.block<3, 3>(slot, slot) - cross - cross.transpose();
  const Eigen::Matrix3d motion = Turned(both, BaseFromOrigin(map_from_base));
  return 0.5 * (motion + motion.transpose());
}

}  // namespace depthgrid
