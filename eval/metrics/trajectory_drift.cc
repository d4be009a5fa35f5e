#include "eval/metrics/trajectory_drift.h"

#include <algorithm>

#include "eval/metrics/statistics.h"
#include "eval/metrics/trajectory_metrics.h"

namespace depthgrid {
namespace {

// `along` (seconds or metres, one per pair) increases.
std::optional<Drift> DriftAlong(const std::vector<PosePair>& pairs,
                                const std::vector<double>& along, double over) {
  // Stamps and paths of exactly the wanted length may be short by a rounding error.
  constexpr double kSlack = 1e-9;
  constexpr double kLongest = 1.5;  // times what is wanted; motions across gaps are not comparable
  std::vector<RelativeStep> steps;
  double total = 0.0;
  for (std::size_t from = 0; from < pairs.size(); ++from) {
    const auto reached = std::lower_bound(along.begin() + static_cast<std::ptrdiff_t>(from),
                                          along.end(), along[from] + over - kSlack);
    if (reached == along.end() || *reached - along[from] > kLongest * over) continue;
    steps.push_back({from, static_cast<std::size_t>(reached - along.begin())});
    total += *reached - along[from];
  }
  if (steps.empty()) return std::nullopt;
  const RelativeErrors errors = ErrorsOf(pairs, steps);
  const Statistics translation = Summarise(errors.translation_m);
  return Drift{over,
               static_cast<int>(steps.size()),
               translation.rmse,
               Summarise(errors.rotation_rad).rmse,
               translation.mean,
               total / static_cast<double>(steps.size())};
}

}  // namespace

std::optional<Drift> DriftOverTime(const std::vector<PosePair>& pairs, double lag_s) {
  std::vector<double> stamps_s;
  for (const PosePair& pair : pairs) stamps_s.push_back(pair.reference.stamp_s);
  return DriftAlong(pairs, stamps_s, lag_s);
}

std::vector<double> ReferencePath(const std::vector<PosePair>& pairs) {
  std::vector<double> path_m(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const Eigen::Vector3d step_m = pairs[i].reference.world_from_camera.translation -
                                   pairs[i - 1].reference.world_from_camera.translation;
    path_m[i] = path_m[i - 1] + step_m.norm();
  }
  return path_m;
}

std::optional<Drift> DriftOverPath(const std::vector<PosePair>& pairs, double length_m) {
  return DriftAlong(pairs, ReferencePath(pairs), length_m);
}

}  // namespace depthgrid
