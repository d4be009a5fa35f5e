#include "sim/laser/odometry_noise.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

// Standard deviations of bias and white error per frame at scale 1, in kUnitM: forward, left (m),
// yaw (rad), fitted to real logs.
constexpr std::array<double, 3> kBias = {0.80, 0.40, 0.22};
constexpr std::array<double, 3> kWhite = {0.65, 0.30, 0.32};
// Scale 1 gives an error of about a millimetre per frame.
constexpr double kUnitM = 1e-3;

using Errors = std::vector<Eigen::Vector3d>;

Errors DrawErrors(std::size_t frames, const OdometryOptions& options, std::uint64_t seed) {
  RandomStream random(seed, RandomStage::kOdometry);
  const double keep = std::exp(-1.0 / options.bias_time_frames);
  const double renew = std::sqrt(1.0 - keep * keep);
  Eigen::Vector3d bias(random.Normal(), random.Normal(), random.Normal());
  Errors errors;
  errors.reserve(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    Eigen::Vector3d error;
    for (int axis = 0; axis < 3; ++axis) {
      bias[axis] = keep * bias[axis] + renew * random.Normal();
      const auto a = static_cast<std::size_t>(axis);
      error[axis] = kUnitM * (kBias[a] * bias[axis] + kWhite[a] * random.Normal());
    }
    errors.push_back(error);
  }
  return errors;
}

std::vector<Pose2> Integrate(const std::vector<Pose2>& truth, const Errors& errors, double scale) {
  std::vector<Pose2> odometry = {truth.front()};
  odometry.reserve(truth.size());
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Pose2 motion = Between(truth[i - 1], truth[i]);
    const Pose2 disturbed = Pose2::FromVector(motion.vector() + scale * errors[i]);
    odometry.push_back(odometry.back() * disturbed);
  }
  return odometry;
}

double MeanError(const std::vector<Pose2>& truth, const std::vector<Pose2>& odometry) {
  double sum_m = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    sum_m += (truth[i].translation() - odometry[i].translation()).norm();
  }
  return sum_m / static_cast<double>(truth.size());
}

// The error grows with the scale while the yaw error is moderate, so this bisects in log scale.
double CalibratedScale(const std::vector<Pose2>& truth, const Errors& errors, double target_m) {
  constexpr double kLeastScale = 1e-4;
  constexpr double kMostScale = 1e2;
  const auto error_m = [&](double scale) {
    return MeanError(truth, Integrate(truth, errors, scale));
  };
  double low = kLeastScale;
  double high = kMostScale;
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (error_m(middle) < target_m ? low : high) = middle;
  }
  const double scale = std::sqrt(low * high);
  constexpr double kTolerance = 1e-3;
  if (std::abs(error_m(scale) - target_m) > kTolerance * target_m) {
    throw SettingError(
        "mean_error_m",
        fmt::format("is {:g}, must be 0 or from {:.3g} to {:.3g}: what odometry over "
                    "this path can err by, of this seed",
                    target_m, error_m(kLeastScale), error_m(kMostScale)));
  }
  return scale;
}

}  // namespace

void OdometryOptions::Visit(OptionsVisitor& v) {
  v.Number("mean_error_m", mean_error_m, {0, 100}, "mean distance from truth over the run");
  v.Number("bias_time_frames", bias_time_frames, {1, 1e6}, "correlation time of the bias");
  v.Number("jitter_m", jitter_m, {0, 1}, "white noise of each pose's position, per axis");
  v.Number("jitter_deg", jitter_deg, {0, 45}, "white noise of each pose's heading");
}

std::vector<Pose2> DisturbOdometry(const std::vector<Pose2>& truth, const OdometryOptions& options,
                                   std::uint64_t seed) {
  Require(!truth.empty(), "a trajectory to disturb has poses");
  std::vector<Pose2> odometry = truth;
  if (options.mean_error_m > 0.0) {
    const Errors errors = DrawErrors(truth.size(), options, seed);
    odometry = Integrate(truth, errors, CalibratedScale(truth, errors, options.mean_error_m));
  }
  if (options.jitter_m == 0.0 && options.jitter_deg == 0.0) return odometry;
  RandomStream random(seed, RandomStage::kOdometry, 1);
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const Pose2 jitter{options.jitter_m * random.Normal(), options.jitter_m * random.Normal(),
                       RadFromDeg(options.jitter_deg) * random.Normal()};
    odometry[i] = odometry[i] * jitter;
  }
  return odometry;
}

}  // namespace depthgrid
