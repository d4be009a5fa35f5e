#include "mapper/fuse/motion_noise.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid {
namespace {

// Information added to each direction: unobserved ones get a sigma of 1 m or 1 rad.
constexpr double kUnseenInformation = 1.0;
// An axis with a larger match sigma is skipped: m, m, rad.
const Eigen::Vector3d kSeenSigma(0.03, 0.03, 0.02);
// Candidate time constants of the bias, frames.
constexpr std::array<double, 4> kBiasFrames = {10.0, 40.0, 160.0, 640.0};
// Least number of independent stretches for a lag to be used.
constexpr double kMinStretches = 3.0;
constexpr int kParts = 3;
// Variance of the product of two errors n1 - n0 and n2 - n1, of unit noise, with twice its
// covariance with the next such product: 5 + 2.
constexpr double kProductVariance = 7.0;
// Jitter told by such products is believed less this many of its own sigmas.
constexpr double kSureSigmas = 2.0;
// Of the first class of matches, 1 um or 1 urad; each has twice the variance of the one before, the
// last more than that of kSeenSigma.
constexpr double kLeastMatchVariance = 1e-12;
// Upper bound of learnt noise, as a multiple of the spread (docs/tried.md, "A nearly perfect
// prior").
constexpr double kMostOfSpread = 2.0;

// The variance that each part, at unit size, gives the error summed over `lag` frames.
std::array<double, kParts> UnitVariances(double lag, double kept) {
  const double gone = 1.0 - kept;
  const double bias =
      lag * (1.0 + kept) / gone - 2.0 * kept * (1.0 - std::pow(kept, lag)) / (gone * gone);
  return {2.0, lag, bias};
}

Eigen::Vector3d Renewed(const Eigen::Vector3d& kept, const Eigen::Vector3d& bias) {
  return (1.0 - kept.array().square()).sqrt().matrix().cwiseProduct(bias);
}

struct Fit3 {
  std::array<double, kParts> variance{};
  double misfit = 0.0;
};

// Non-negative least squares of the variances over all lags, by trying every subset of the parts.
Fit3 FitParts(const std::vector<double>& lag, const std::vector<double>& variance,
              const std::vector<double>& weight, double kept) {
  Fit3 best;
  best.misfit = std::numeric_limits<double>::infinity();
  for (unsigned subset = 1; subset < (1U << kParts); ++subset) {
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    const auto columns = [&](double l) {
      const std::array<double, kParts> unit = UnitVariances(l, kept);
      Eigen::Vector3d row = Eigen::Vector3d::Zero();
      for (int p = 0; p < kParts; ++p) {
        if (subset & (1U << p)) row[p] = unit[static_cast<std::size_t>(p)];
      }
      return row;
    };
    for (std::size_t i = 0; i < lag.size(); ++i) {
      const Eigen::Vector3d row = columns(lag[i]);
      h += weight[i] * row * row.transpose();
      g += weight[i] * variance[i] * row;
    }
    for (int p = 0; p < kParts; ++p) {
      if (!(subset & (1U << p))) h(p, p) = 1.0;
    }
    const Eigen::Vector3d solution = h.fullPivLu().solve(g);
    if ((solution.array() < 0.0).any()) continue;
    double misfit = 0.0;
    for (std::size_t i = 0; i < lag.size(); ++i) {
      const double error = variance[i] - columns(lag[i]).dot(solution);
      misfit += weight[i] * error * error;
    }
    if (misfit >= best.misfit) continue;
    best.misfit = misfit;
    for (int p = 0; p < kParts; ++p) best.variance[static_cast<std::size_t>(p)] = solution[p];
  }
  return best;
}

}  // namespace

MotionErrors ErrorsOver(int frames, const MotionNoise& noise) {
  MotionErrors errors;
  if (frames == 0) {
    errors.bias_added.setZero();
    errors.bias_kept.setOnes();
    return errors;
  }
  errors.walk = noise.walk;
  errors.bias_kept = noise.bias_kept;
  for (int axis = 0; frames > 1 && axis < 3; ++axis) {
    const double kept = noise.bias_kept[axis];
    errors.bias_kept[axis] = std::pow(kept, frames);
    errors.bias_added[axis] = kept < 1.0 ? (1.0 - errors.bias_kept[axis]) / (1.0 - kept) : frames;
    // Bias arising on the way adds to the pose too: the variance of the summed bias less the old
    // bias's part.
    const double added = errors.bias_added[axis];
    const double sum = kept < 1.0 ? UnitVariances(frames, kept)[2] : added * added;
    const double new_bias =
        std::max(0.0, sum - added * added) * noise.bias[axis] * noise.bias[axis];
    errors.walk[axis] = std::sqrt(frames * noise.walk[axis] * noise.walk[axis] + new_bias);
  }
  errors.bias_renewed = Renewed(errors.bias_kept, noise.bias);
  return errors;
}

// Over n frames a bias grows like n, a walk like the root of n.
void Bound(const MotionSpread& spread, MotionNoise& noise) {
  const double root = std::sqrt(spread.frames);
  const Eigen::Vector3d most = kMostOfSpread * spread.sigma;
  for (int axis = 0; axis < 3; ++axis) {
    if (!spread.Tells(axis)) continue;
    noise.bias[axis] = std::min(noise.bias[axis], most[axis]);
    noise.walk[axis] = std::min(noise.walk[axis], root * most[axis]);
    const double least = spread.sigma[axis];
    const double walked = noise.walk[axis] / root;
    const double bias = std::sqrt(std::max(least * least - walked * walked, 0.0));
    if (noise.bias[axis] >= bias) continue;
    // If no bias was learnt, its time constant is unknown.
    if (noise.bias[axis] == 0.0) noise.bias_kept[axis] = MotionNoise().bias_kept[axis];
    noise.bias[axis] = bias;
  }
}

void MotionNoiseLearner::Add(const Eigen::Vector3d& error, const Eigen::Vector3d& match_sigma) {
  ++motions_;
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (!(match_sigma[i] < kSeenSigma[i])) {
      axis.run = 0;
      axis.last.reset();
      continue;
    }
    AddPair({error[i], match_sigma[i] * match_sigma[i]}, axis);
    axis.match_variance += match_sigma[i] * match_sigma[i];
    ++axis.matches;
    axis.summed_error[static_cast<std::size_t>(axis.run % kRing)] = axis.total;
    axis.total += error[i];
    ++axis.run;
    for (int lag = 0; lag < kLags; ++lag) {
      const int frames = 1 << lag;
      if (axis.run < frames) break;
      const double before =
          axis.summed_error[static_cast<std::size_t>((axis.run - frames) % kRing)];
      const double summed = axis.total - before;
      axis.sum_squares[static_cast<std::size_t>(lag)] += summed * summed;
      axis.count[static_cast<std::size_t>(lag)] += 1.0;
    }
  }
}

void MotionNoiseLearner::AddStanding(const Eigen::Vector3d& error,
                                     const Eigen::Vector3d& match_sigma) {
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    axis.last.reset();
    if (match_sigma[i] < kSeenSigma[i]) {
      axis.total += error[i];
    } else {
      axis.run = 0;
    }
  }
}

void MotionNoiseLearner::AddMatches(const Pose2& motion, bool stands, const MatchResult& before,
                                    const MatchResult& now) {
  const Pose2 matched_motion = Between(before.map_from_base, now.map_from_base);
  const Eigen::Matrix3d information =
      now.information + kUnseenInformation * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d error = Between(motion, matched_motion).vector();
  const Eigen::Vector3d match_sigma = information.inverse().diagonal().cwiseSqrt();
  if (stands) {
    AddStanding(error, match_sigma);
  } else {
    Add(error, match_sigma);
  }
}

void MotionNoiseLearner::Break() {
  for (Axis& axis : axes_) {
    axis.run = 0;
    axis.last.reset();
  }
}

void MotionNoiseLearner::AddPair(const Motion& motion, Axis& axis) {
  if (axis.last) {
    const int exponent = std::ilogb(std::max(axis.last->match_variance, kLeastMatchVariance));
    const int place = std::clamp(exponent - std::ilogb(kLeastMatchVariance), 0, kClasses - 1);
    MatchClass& one = axis.classes[static_cast<std::size_t>(place)];
    one.products -= axis.last->error * motion.error;
    one.match_variance += axis.last->match_variance;
    one.count += 1.0;
  }
  axis.last = motion;
}

// Each class tells the jitter's variance with a variance of kProductVariance (match variance +
// jitter variance)^2 / count. Matches that see little claim a larger error than they have, since
// what they do not see they take from the prediction, so in the mean of all of them nothing may be
// left.
double MotionNoiseLearner::JitterVariance(const Axis& axis, double shared_bias) {
  constexpr int kRounds = 10;  // the weights depend on what is sought
  double jitter = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0, weights = 0.0;
    for (const MatchClass& one : axis.classes) {
      if (one.count == 0.0) continue;
      const double match = std::max(one.match_variance / one.count, kLeastMatchVariance);
      const double weight = one.count / ((match + jitter) * (match + jitter));
      sum += weight * (one.products / one.count - match);
      weights += weight;
    }
    if (weights == 0.0) return 0.0;
    const double sigma = std::sqrt(kProductVariance / weights);
    jitter = std::max(sum / weights + shared_bias - kSureSigmas * sigma, 0.0);
  }
  return jitter;
}

std::optional<MotionNoiseLearner::AxisNoise> MotionNoiseLearner::FitAxis(const Axis& axis) const {
  std::vector<double> lags;
  std::vector<double> variances;
  std::vector<double> weights;
  for (std::size_t i = 0; i < kLags; ++i) {
    const double lag = std::pow(2.0, static_cast<double>(i));
    const double stretches = axis.count[i] / lag;
    if (stretches < kMinStretches) continue;
    const double variance = std::max(axis.sum_squares[i] / axis.count[i], 1e-14);
    lags.push_back(lag);
    variances.push_back(variance);
    weights.push_back(stretches / (variance * variance));
  }
  if (lags.empty()) return {};
  AxisNoise noise;
  Fit3 best;
  best.misfit = std::numeric_limits<double>::infinity();
  for (const double frames : kBiasFrames) {
    const double kept = std::exp(-1.0 / frames);
    const Fit3 fit = FitParts(lags, variances, weights, kept);
    if (fit.misfit >= best.misfit) continue;
    best = fit;
    noise.kept = kept;
  }
  // The variance includes the matches' own.
  const double match_variance = axis.match_variance / std::max(axis.matches, 1);
  noise.jitter = std::sqrt(std::max(best.variance[0] - match_variance,
                                    JitterVariance(axis, best.variance[2] * noise.kept)));
  noise.walk = std::sqrt(best.variance[1]);
  noise.bias = std::sqrt(best.variance[2]);
  return noise;
}

std::array<int, 3> MotionNoiseLearner::seen() const {
  return {axes_[0].matches, axes_[1].matches, axes_[2].matches};
}

MotionNoise MotionNoiseLearner::Fit(const MotionNoise& unknown) const {
  MotionNoise noise = unknown;
  for (int i = 0; i < 3; ++i) {
    const std::optional<AxisNoise> axis = FitAxis(axes_[static_cast<std::size_t>(i)]);
    if (!axis) continue;
    noise.jitter[i] = axis->jitter;
    noise.walk[i] = axis->walk;
    noise.bias[i] = axis->bias;
    noise.bias_kept[i] = axis->kept;
  }
  return noise;
}

}  // namespace depthgrid
