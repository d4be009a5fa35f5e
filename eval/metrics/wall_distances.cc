#include "eval/metrics/wall_distances.h"

#include <algorithm>
#include <array>
#include <utility>

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/nearest_points.h"
#include "eval/metrics/statistics.h"

namespace depthgrid {
namespace {

double ShareWithin(const std::vector<double>& distances_m, double limit_m) {
  const auto within = std::count_if(distances_m.begin(), distances_m.end(),
                                    [&](double d) { return d <= limit_m + kCentreSlackM; });
  return static_cast<double>(within) / static_cast<double>(distances_m.size());
}

std::vector<Eigen::Vector2d> Moved(const Pose2& motion, std::vector<Eigen::Vector2d> points) {
  for (Eigen::Vector2d& p : points) p = motion * p;
  return points;
}

// The points of a map's walls that count, and all that distances from the other map's are to.
struct WallSide {
  std::vector<Eigen::Vector2d> counted;
  std::vector<Eigen::Vector2d> targets;
};

WallSide SideOfTruth(const ScoredCells& walls, std::vector<Eigen::Vector2d> targets) {
  return {CentresOf(InBoth(walls.truth, walls.scored)), std::move(targets)};
}

WallSide SideOfEstimate(const ScoredCells& walls, const Pose2& truth_from_estimate,
                        std::vector<Eigen::Vector2d> targets) {
  WallSide side;
  for (const Eigen::Vector2d& p : Moved(truth_from_estimate, CentresOf(walls.estimate))) {
    if (walls.scored.Has(CellOf(p, walls.scored.geometry.resolution_m))) side.counted.push_back(p);
  }
  side.targets = Moved(truth_from_estimate, std::move(targets));
  return side;
}

// Distances from each map's counted points to the other map's targets.
struct BothWays {
  std::vector<double> forth_m;  // from the estimate
  std::vector<double> back_m;
};

BothWays DistancesBetween(const WallSide& truth, const WallSide& estimate) {
  if (truth.targets.empty() || estimate.targets.empty()) return {};
  return {NearestDistances(estimate.counted, truth.targets),
          NearestDistances(truth.counted, estimate.targets)};
}

// Centres, and points on the lines from each to those of its neighbours.
std::vector<Eigen::Vector2d> LinesThrough(const CellSet& walls) {
  constexpr std::array<double, 3> kOnTheWay = {0.25, 0.5, 0.75};
  constexpr std::array<Cell, 4> kHalfOfNeighbours = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  const double resolution_m = walls.geometry.resolution_m;
  std::vector<Eigen::Vector2d> points = CentresOf(walls);
  for (std::size_t i = 0; i < walls.members.size(); ++i) {
    if (walls.members[i] == 0) continue;
    const Cell cell = walls.geometry.CellAt(i);
    for (const Cell& step : kHalfOfNeighbours) {
      if (!walls.Has({cell.x + step.x, cell.y + step.y})) continue;
      for (const double share : kOnTheWay) {
        points.emplace_back(CellCentre(cell, resolution_m) +
                            share * resolution_m * Eigen::Vector2d(step.x, step.y));
      }
    }
  }
  return points;
}

}  // namespace

std::vector<double> NearestDistances(const std::vector<Eigen::Vector2d>& points,
                                     const std::vector<Eigen::Vector2d>& targets) {
  const NearestPoints nearest(targets);
  std::vector<double> distances_m;
  distances_m.reserve(points.size());
  for (const Eigen::Vector2d& p : points) distances_m.push_back(nearest.DistanceFrom(p));
  return distances_m;
}

DistanceScore ScoreOfDistances(const std::vector<double>& estimate_to_truth_m,
                               const std::vector<double>& truth_to_estimate_m) {
  constexpr double kFraction = 0.95;
  DistanceScore score;
  if (!estimate_to_truth_m.empty()) {
    score.estimate_to_truth_m = Summarise(estimate_to_truth_m).mean;
  }
  if (!truth_to_estimate_m.empty()) {
    score.truth_to_estimate_m = Summarise(truth_to_estimate_m).mean;
  }
  if (estimate_to_truth_m.empty() || truth_to_estimate_m.empty()) return score;
  score.chamfer_m = 0.5 * (*score.estimate_to_truth_m + *score.truth_to_estimate_m);
  score.hausdorff95_m = std::max(Percentile(estimate_to_truth_m, kFraction),
                                 Percentile(truth_to_estimate_m, kFraction));
  return score;
}

WallDistanceScore ScoreWallDistances(const ScoredCells& walls, const Pose2& truth_from_estimate) {
  const auto [forth_m, back_m] =
      DistancesBetween(SideOfTruth(walls, CentresOf(walls.truth)),
                       SideOfEstimate(walls, truth_from_estimate, CentresOf(walls.estimate)));
  WallDistanceScore score;
  static_cast<DistanceScore&>(score) = ScoreOfDistances(forth_m, back_m);
  if (forth_m.empty() || back_m.empty()) return score;
  score.f1_5cm = F1Of(ShareWithin(forth_m, 0.05), ShareWithin(back_m, 0.05));
  score.f1_10cm = F1Of(ShareWithin(forth_m, 0.10), ShareWithin(back_m, 0.10));
  return score;
}

std::optional<LineDistances> DistancesToWallLines(const ScoredCells& walls,
                                                  const Pose2& truth_from_estimate) {
  const auto [forth_m, back_m] =
      DistancesBetween(SideOfTruth(walls, LinesThrough(walls.truth)),
                       SideOfEstimate(walls, truth_from_estimate, LinesThrough(walls.estimate)));
  if (forth_m.empty() || back_m.empty()) return {};
  return LineDistances{Summarise(forth_m).mean, Summarise(back_m).mean};
}

}  // namespace depthgrid
