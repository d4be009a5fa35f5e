#include "sim/slam/error_growth.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid {
namespace {

// Of one lag: short lags have far more pairs, and would decide alone.
constexpr double kMaxWeight = 100.0;

using Rows = Eigen::MatrixX4d;

// The growth at a lag per unit of each term's square.
Eigen::RowVector4d TermsAt(const CorrelationTimes& times, double lag_s) {
  const double x = lag_s / times.drift_s;
  return {2.0, -2.0 * std::expm1(-lag_s / times.bias_s), lag_s,
          2.0 * times.drift_s * times.drift_s * (x + std::expm1(-x))};
}

// Least squares over the columns whose bit is set in `mask`; the other unknowns are 0.
Eigen::Vector4d Solve(const Rows& rows, const Eigen::VectorXd& target, int mask) {
  Rows used = rows;
  Eigen::Matrix4d unused = Eigen::Matrix4d::Zero();
  for (int k = 0; k < 4; ++k) {
    if (mask & (1 << k)) continue;
    used.col(k).setZero();
    unused(k, k) = 1.0;
  }
  return (used.transpose() * used + unused).ldlt().solve(used.transpose() * target);
}

}  // namespace

std::vector<Growth> MeasureGrowth(const std::vector<ErrorTrack>& tracks, int axes) {
  std::size_t longest = 0;
  for (const ErrorTrack& track : tracks) longest = std::max(longest, track.size());
  std::vector<Growth> growth;
  std::size_t lag = 1;  // Fibonacci numbers
  for (std::size_t next = 2; lag <= longest / 3; std::swap(lag, next), next += lag) {
    double sum = 0.0;
    double time_s = 0.0;
    double pairs = 0.0;
    for (const ErrorTrack& track : tracks) {
      for (std::size_t i = lag; i < track.size(); ++i) {
        sum += (track[i].error - track[i - lag].error).squaredNorm() / axes;
        time_s += track[i].stamp_s - track[i - lag].stamp_s;
        ++pairs;
      }
    }
    if (sum == 0.0) continue;
    const double stretches = pairs / static_cast<double>(lag);
    growth.push_back({time_s / pairs, sum / pairs, std::min(kMaxWeight, stretches)});
  }
  return growth;
}

double GrowthOf(const GrowthTerms& terms, const CorrelationTimes& times, double lag_s) {
  const Eigen::Vector4d sigmas(terms.jitter, terms.bias, terms.walk, terms.drift);
  return TermsAt(times, lag_s) * sigmas.cwiseAbs2();
}

GrowthTerms FitGrowth(const std::vector<Growth>& growth, const CorrelationTimes& times,
                      double known_walk_square) {
  if (growth.empty()) return {};
  const auto count = static_cast<Eigen::Index>(growth.size());
  Rows rows(count, 4);
  Eigen::VectorXd target(count);
  double weights = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Growth& point = growth[static_cast<std::size_t>(i)];
    const double scale = std::sqrt(point.weight) / point.mean_square;
    target[i] = scale * (point.mean_square - known_walk_square * point.lag_s);
    rows.row(i) = scale * TermsAt(times, point.lag_s);
    weights += point.weight;
  }
  GrowthTerms best;
  best.misfit = std::numeric_limits<double>::infinity();
  // Non-negative least squares by trying all subsets of the four unknowns.
  for (int mask = 0; mask < 16; ++mask) {
    const Eigen::Vector4d squares = Solve(rows, target, mask);
    const double misfit = (rows * squares - target).squaredNorm() / weights;
    if (squares.minCoeff() < 0.0 || !(misfit < best.misfit)) continue;
    const Eigen::Vector4d sigmas = squares.cwiseSqrt();
    best = {sigmas[0], sigmas[1], sigmas[2], sigmas[3], misfit};
  }
  return best;
}

}  // namespace depthgrid
