#include "sim/slam/slam_calibration.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/error.h"
#include "sim/slam/slam_surrogate.h"

namespace depthgrid {
namespace {

constexpr double kLargestScale = 1000.0;  // limit of SlamOptions
constexpr double kTolerance = 1e-3;       // relative to the target
constexpr int kMaxTrials = 40;
constexpr double kLeastShare = 0.1;  // least share of the bracket that a trial removes

double LiveErrorM(const Trajectory& truth, const SlamOutput& output) {
  double sum_m = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!output.live[i].slam_from_camera) continue;
    const Eigen::Vector3d error =
        output.live[i].slam_from_camera->translation - truth[i].world_from_camera.translation;
    sum_m += error.head<2>().norm();
    ++count;
  }
  return count == 0 ? 0.0 : sum_m / count;
}

struct Trial {
  double scale = 0.0;
  double error_m = 0.0;
};

}  // namespace

double MeanLiveErrorM(const Trajectory& truth, const SlamOptions& options, const SeedRange& seeds) {
  Require(!truth.empty() && seeds.count > 0, "an error is of some poses and some seeds");
  double sum_m = 0.0;
  for (int i = 0; i < seeds.count; ++i) {
    const std::uint64_t seed = seeds.first + static_cast<std::uint64_t>(i);
    sum_m += LiveErrorM(truth, DisturbTrajectory(truth, options, seed));
  }
  return sum_m / seeds.count;
}

DriftCalibration CalibrateDrift(const Trajectory& truth, SlamOptions options, double target_m,
                                const SeedRange& seeds) {
  const auto tried = [&](double scale) -> Trial {
    options.drift_scale = scale;
    return {scale, MeanLiveErrorM(truth, options, seeds)};
  };
  Trial low = tried(0.0);
  if (low.error_m > target_m) return {low.scale, low.error_m, false};
  Trial high = tried(1.0);
  while (high.error_m < target_m) {
    if (high.scale >= kLargestScale) return {high.scale, high.error_m, false};
    low = high;
    high = tried(std::min(2.0 * high.scale, kLargestScale));
  }
  // Regula falsi with trials kept away from the ends, so that the bracket shrinks from both sides.
  Trial best = high;
  for (int i = 0; i < kMaxTrials; ++i) {
    if (std::abs(best.error_m - target_m) <= kTolerance * target_m) {
      return {best.scale, best.error_m, true};
    }
    const double share = std::clamp((target_m - low.error_m) / (high.error_m - low.error_m),
                                    kLeastShare, 1.0 - kLeastShare);
    best = tried(low.scale + share * (high.scale - low.scale));
    (best.error_m < target_m ? low : high) = best;
  }
  return {best.scale, best.error_m, false};
}

}  // namespace depthgrid
