#include "eval/statistics/score_names.h"

#include <algorithm>
#include <array>

namespace depthgrid {

bool IsBreakdown(std::string_view path) {
  constexpr std::array<std::string_view, 7> kGroups = {
      "xy", "xyz", "rotation_rad", "heading_rad", "rpe", "drift", "confusion"};
  constexpr std::array<std::string_view, 3> kOfConsistency = {"low", "high", "samples"};
  const auto has = [](const auto& keys, std::string_view key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  const std::string_view key = path.substr(path.rfind('.') + 1);
  return has(kGroups, key) || key.starts_with("tolerance_") || key.ends_with("_cells") ||
         key.ends_with("_poses") || (path.starts_with("consistency.") && has(kOfConsistency, key));
}

bool IsGroupOfScores(std::string_view path) {
  constexpr std::array<std::string_view, 8> kGroups = {
      "trajectory.slam",    "trajectory.online",       "trajectory.est",  "map.registered",
      "map.wall_thickness", "map.true_wall_thickness", "map.calibration", "map.navigability"};
  return std::find(kGroups.begin(), kGroups.end(), path) != kGroups.end();
}

std::span<const std::string_view> ScoresOfASweepsPage() {
  static constexpr std::array<std::string_view, 6> kScores = {"trajectory.est.mean_euclidean_m",
                                                              "trajectory.est.ate_rmse_se2_m",
                                                              "map.observable.occupied.f1",
                                                              "map.chamfer_m",
                                                              "map.coverage",
                                                              "trajectory.slam.mean_euclidean_m"};
  return kScores;
}

std::span<const std::string_view> ScoresToCompare() {
  static constexpr std::array<std::string_view, 13> kScores = {"trajectory.est.mean_euclidean_m",
                                                               "map.observable.occupied.f1",
                                                               "trajectory.est.ate_rmse_se2_m",
                                                               "map.chamfer_m",
                                                               "trajectory.online.mean_euclidean_m",
                                                               "map.coverage",
                                                               "map.observable.free.f1",
                                                               "map.registered.chamfer_m",
                                                               "map.double_wall_rate",
                                                               "map.ssim",
                                                               "map.calibration.brier",
                                                               "map.navigability.success_rate",
                                                               "map.navigability.collision_rate"};
  return kScores;
}

std::span<const std::string_view> ScoresOfAnAblation() {
  static constexpr std::array<std::string_view, 5> kScores = {
      "trajectory.online.mean_euclidean_m", "trajectory.est.mean_euclidean_m",
      "map.observable.occupied.f1", "map.chamfer_m", "map.navigability.success_rate"};
  return kScores;
}

}  // namespace depthgrid
