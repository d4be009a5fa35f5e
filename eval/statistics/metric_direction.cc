#include "eval/statistics/metric_direction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace depthgrid {
namespace {

// Whether one of the separated parts of `text` is among these words.
bool HasAny(std::string_view text, char separator, std::span<const std::string_view> words) {
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(separator, from), text.size());
    const std::string_view part = text.substr(from, end - from);
    if (std::find(words.begin(), words.end(), part) != words.end()) return true;
    from = end + 1;
  }
  return false;
}

bool IsDescription(std::string_view metric, std::string_view last) {
  constexpr std::array<std::string_view, 4> kGroups = {"wall_thickness", "true_wall_thickness",
                                                       "truthless", "truthless_of_truth"};
  constexpr std::array<std::string_view, 6> kCounts = {"cells",      "pairs",   "planned",
                                                       "collisions", "samples", "reference_path_m"};
  return HasAny(metric, '.', kGroups) || last.ends_with("_cells") || last.ends_with("_poses") ||
         std::find(kCounts.begin(), kCounts.end(), last) != kCounts.end();
}

}  // namespace

std::optional<double> TargetOf(std::string_view metric) {
  // length_ratio: a planned path shorter than the shortest true one leads through walls.
  constexpr std::array<std::pair<std::string_view, double>, 8> kTargets = {
      {{"nis.mean", 1.0},
       {"nees.mean", 1.0},
       {".within_95", 0.95},
       {".sim3_scale", 1.0},
       {".registered.x_m", 0.0},
       {".registered.y_m", 0.0},
       {".registered.yaw_rad", 0.0},
       {".length_ratio", 1.0}}};
  for (const auto& [ending, target] : kTargets) {
    if (metric.ends_with(ending)) return target;
  }
  return std::nullopt;
}

double DistanceFrom(double target, double score) {
  const double distance = std::abs(score - target);
  return distance <= kRoundingShare * std::abs(target) ? 0.0 : distance;
}

Better BetterOf(std::string_view metric) {
  constexpr std::array<std::string_view, 9> kHigher = {
      "precision", "recall", "f1", "iou", "mcc", "coverage", "ssim", "success", "accuracy"};
  const std::string_view last = metric.substr(metric.rfind('.') + 1);
  if (TargetOf(metric)) return Better::kLower;
  if (IsDescription(metric, last)) return Better::kNeither;
  return HasAny(last, '_', kHigher) ? Better::kHigher : Better::kLower;
}

const char* NameOf(Better better) {
  switch (better) {
    case Better::kLower:
      return "lower";
    case Better::kHigher:
      return "higher";
    case Better::kNeither:
      break;
  }
  return "neither";
}

}  // namespace depthgrid
