// Walls compared as points: distances between the centres of wall cells, after a motion of the
// estimate.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "eval/metrics/cell_maps.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// Euclidean distance from each point to the nearest of the targets, exact, in metres; at least one
// target.
std::vector<double> NearestDistances(const std::vector<Eigen::Vector2d>& points,
                                     const std::vector<Eigen::Vector2d>& targets);

// Distances between the walls of two maps, metres. Empty without a wall that counts.
struct DistanceScore {
  // Santos et al. 2013: mean distance to the nearest wall of the other map ("normalised error" and
  // its reverse).
  std::optional<double> estimate_to_truth_m;
  std::optional<double> truth_to_estimate_m;
  std::optional<double> chamfer_m;  // mean of the two
  // The greater of the 95th percentiles of the two directions: the Hausdorff distance but for a
  // twentieth of the walls.
  std::optional<double> hausdorff95_m;
};

// Of the distances from each of the estimate's walls that count to the truth's, and back.
DistanceScore ScoreOfDistances(const std::vector<double>& estimate_to_truth_m,
                               const std::vector<double>& truth_to_estimate_m);

struct WallDistanceScore : DistanceScore {
  // Harmonic mean of the shares of wall cells within 5 and 10 cm of the other map's walls.
  std::optional<double> f1_5cm;
  std::optional<double> f1_10cm;
};

// The estimate's walls, which may have their own geometry, are moved first. Counted are those that
// then lie in scored cells, and the true walls in scored cells. The true walls and the scored cells
// have the same geometry.
WallDistanceScore ScoreWallDistances(const ScoredCells& walls,
                                     const Pose2& truth_from_estimate = {});

struct LineDistances {
  double estimate_to_truth_m = 0.0;
  double truth_to_estimate_m = 0.0;
};

// Mean distances from wall cells, as above, to lines between the centres of the other map's
// neighbouring wall cells. Unlike distances between centres, they do not grow when a wall is moved
// along itself by part of a cell. Empty when no wall counts in one of the directions.
std::optional<LineDistances> DistancesToWallLines(const ScoredCells& walls,
                                                  const Pose2& truth_from_estimate = {});

}  // namespace depthgrid
