#include "eval/doubts/scale_check.h"

#include <cmath>
#include <vector>

#include "eval/doubts/stretches.h"

namespace depthgrid {
namespace {

// docs/tried.md, "Depth scales that are slightly wrong": what right and wrong scales give.
constexpr double kLeastFactor = 1.04;
constexpr double kSureSigmas = 5.0;
constexpr double kMostLeftShare = 0.08;
// Groups of successive stretches, as SLAM's errors are alike from one to the next.
constexpr std::size_t kStretchGroups = 12;

// Sums over stretches.
struct MotionSums {
  double slam = 0.0, map = 0.0, product = 0.0;  // m^2

  void Add(const Stretch& stretch, double sign = 1.0) {
    const Eigen::Vector2d of_slam = stretch.slam.translation();
    const Eigen::Vector2d of_map = stretch.map.translation();
    slam += sign * of_slam.squaredNorm();
    map += sign * of_map.squaredNorm();
    product += sign * of_slam.dot(of_map);
  }
  // Noise in either sequence flattens the line that is fitted over it, so the true ratio lies
  // between the slope of the map over SLAM and that of SLAM over the map, turned round; this is
  // their geometric mean.
  double Ratio() const { return std::sqrt(map / slam); }
  bool Differs(double factor) const { return product > factor * slam || factor * map < product; }
  double Left(double ratio) const { return map - 2.0 * ratio * product + ratio * ratio * slam; }
};

// The jackknife's: each group left out in turn.
double SigmaOf(const std::vector<Stretch>& stretches, const MotionSums& all) {
  double squares = 0.0;
  const std::size_t count = stretches.size();
  for (std::size_t group = 0; group < kStretchGroups; ++group) {
    MotionSums without = all;
    const std::size_t end = (group + 1) * count / kStretchGroups;
    for (std::size_t i = group * count / kStretchGroups; i < end; ++i) {
      without.Add(stretches[i], -1.0);
    }
    const double off = std::log(without.Ratio() / all.Ratio());
    squares += off * off;
  }
  return std::sqrt((1.0 - 1.0 / static_cast<double>(kStretchGroups)) * squares);
}

}  // namespace

std::optional<ScaleFault> SlightScaleDoubt(const MappingRun& run) {
  const auto done = [](const Stretch& stretch) { return stretch.longer_m() >= kStretchM; };
  const std::vector<Stretch> stretches = StretchesOf(run, done);
  if (stretches.size() < kStretchGroups) return {};
  MotionSums sums;
  for (const Stretch& stretch : stretches) sums.Add(stretch);
  if (!(sums.slam > 0.0) || !(sums.map > 0.0) || !sums.Differs(kLeastFactor)) return {};
  const double ratio = sums.Ratio();
  if (sums.Left(ratio) > kMostLeftShare * sums.Left(1.0)) return {};
  const double sigma = SigmaOf(stretches, sums);
  if (!(std::abs(std::log(ratio)) > kSureSigmas * sigma)) return {};
  return ScaleFault{WaysOf(run), ratio, sigma};
}

}  // namespace depthgrid
