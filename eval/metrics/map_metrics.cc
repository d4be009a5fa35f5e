#include "eval/metrics/map_metrics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/distance_transform.h"
#include "eval/metrics/wall_distances.h"

namespace depthgrid {
namespace {

// Cells that are in both sets.
int CountBoth(const CellSet& a, const CellSet& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.members.size(); ++i) count += a.members[i] & b.members[i];
  return count;
}

// How many cells count, and how many of them `near` covers.
struct Tally {
  int counted = 0;
  int matched = 0;
};
Tally Count(const CellSet& counting, const CellSet& near) {
  return {CountBoth(counting, counting), CountBoth(counting, near)};
}

StateScore ScoreState(const ScoredCells& cells, int tolerance_cells) {
  const auto& [truth, estimate, scored] = cells;
  const Tally right = Count(InBoth(estimate, scored), Grown(truth, tolerance_cells));
  const Tally found = Count(InBoth(truth, scored), Grown(estimate, tolerance_cells));
  StateScore score;
  score.estimated_cells = right.counted;
  score.right_cells = right.matched;
  score.true_cells = found.counted;
  score.found_cells = found.matched;
  score.precision = Ratio(right.matched, right.counted);
  score.recall = Ratio(found.matched, found.counted);
  score.f1 = F1Of(score.precision, score.recall);
  if (score.f1) score.iou = *score.f1 / (2.0 - *score.f1);
  return score;
}

// Distances in metres from each member of `from` to where `squared_to` is 0.
std::vector<double> DirectedDistances(const CellSet& from, const std::vector<double>& squared_to) {
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < from.members.size(); ++i) {
    if (from.members[i] == 0) continue;
    distances_m.push_back(std::sqrt(squared_to[i]) * from.geometry.resolution_m);
  }
  return distances_m;
}

bool IsEmpty(const CellSet& mask) {
  return std::find(mask.members.begin(), mask.members.end(), 1) == mask.members.end();
}

DistanceScore ScoreDistances(const ScoredCells& walls) {
  const auto& [truth, estimate, scored] = walls;
  if (IsEmpty(truth) || IsEmpty(estimate)) return {};
  return ScoreOfDistances(DirectedDistances(InBoth(estimate, scored), SquaredDistances(truth)),
                          DirectedDistances(InBoth(truth, scored), SquaredDistances(estimate)));
}

void ScoreConfusion(const ScoredMaps& maps, CellScores& scores) {
  for (std::size_t i = 0; i < maps.truth.states.size(); ++i) {
    if (maps.scored.members[i] == 0) continue;
    const auto row = static_cast<std::size_t>(maps.truth.states[i]);
    const auto column = static_cast<std::size_t>(maps.estimate.states[i]);
    ++scores.confusion[row][column];
    ++scores.scored_cells;
  }
}

// Of the 2 x 2 table that asks only whether a cell is in this state.
std::optional<double> Matthews(const CellScores& scores, CellState state) {
  const auto asked = static_cast<std::size_t>(state);
  double both = 0.0;
  double truth_only = 0.0;
  double estimate_only = 0.0;
  double neither = 0.0;
  for (std::size_t t = 0; t < scores.confusion.size(); ++t) {
    for (std::size_t e = 0; e < scores.confusion.size(); ++e) {
      double& sum =
          t == asked ? (e == asked ? both : truth_only) : (e == asked ? estimate_only : neither);
      sum += scores.confusion[t][e];
    }
  }
  const double product = (both + truth_only) * (both + estimate_only) * (neither + truth_only) *
                         (neither + estimate_only);
  return Ratio(both * neither - truth_only * estimate_only, std::sqrt(product));
}

// `to_cover` are the cells that coverage asks for.
CellScores ScoreCells(const ScoredMaps& maps, const CellSet& to_cover) {
  const CellSet true_walls = CellsIn(maps.truth, CellState::kOccupied);
  const CellSet walls = CellsIn(maps.estimate, CellState::kOccupied);
  const CellSet true_free = CellsIn(maps.truth, CellState::kFree);
  const CellSet free = CellsIn(maps.estimate, CellState::kFree);
  const ScoredCells occupied = {.truth = true_walls, .estimate = walls, .scored = maps.scored};
  CellScores scores;
  static_cast<DistanceScore&>(scores) = ScoreDistances(occupied);
  for (int tolerance = 0; tolerance <= kMaxToleranceCells; ++tolerance) {
    const auto index = static_cast<std::size_t>(tolerance);
    scores.occupied[index] = ScoreState(occupied, tolerance);
    scores.free[index] =
        ScoreState({.truth = true_free, .estimate = free, .scored = maps.scored}, tolerance);
  }
  ScoreConfusion(maps, scores);
  scores.occupied_mcc = Matthews(scores, CellState::kOccupied);
  scores.free_mcc = Matthews(scores, CellState::kFree);
  const int asked = CountBoth(to_cover, to_cover);
  scores.coverage = Ratio(CountBoth(to_cover, walls) + CountBoth(to_cover, free), asked);
  return scores;
}

}  // namespace

MapScore ScoreMap(const StateMap& truth, const StateMap& estimate,
                  const std::optional<CellSet>& observable) {
  ScoredMaps maps = OnOneGeometry(truth, estimate, observable);
  MapScore score;
  if (observable) score.observable = ScoreCells(maps, maps.scored);
  std::fill(maps.scored.members.begin(), maps.scored.members.end(), 1);
  score.all = ScoreCells(maps, KnownCells(maps.truth));
  return score;
}

}  // namespace depthgrid
