// How well an estimated map agrees with the true one, cell by cell and by distance.
//
// Both maps are compared in three states on one grid. Scores are given over the observable cells
// and over all cells of both maps:
//  - precision counts estimated cells of a state that lie in the scored set; each is right if a
//    true cell of that state, anywhere, is within the tolerance,
//  - recall counts true cells of that state that lie in the scored set; each is found if an
//    estimated cell of that state, anywhere, is within the tolerance. So an estimated wall in an
//    unobservable cell counts against precision only in the "all" score.
#pragma once

#include <array>
#include <optional>

#include "eval/metrics/map_quality.h"
#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

constexpr int kMaxToleranceCells = 2;
// Tolerance of the scores that have none in their name (docs/conventions.md).
constexpr int kDefaultToleranceCells = 1;

struct StateScore {
  int estimated_cells = 0;
  int right_cells = 0;  // of the estimated
  int true_cells = 0;
  int found_cells = 0;  // of the true
  // Empty when the divisor is zero.
  std::optional<double> precision;
  std::optional<double> recall;
  std::optional<double> f1;
  // F1 / (2 - F1): at tolerance 0 the intersection over the union of the two sets.
  std::optional<double> iou;
};

// Distances are between centres of occupied cells; of those that are scored to all of the other
// map. Empty when either map has none.
struct CellScores : DistanceScore {
  std::array<StateScore, kMaxToleranceCells + 1> occupied;  // by tolerance in cells
  std::array<StateScore, kMaxToleranceCells + 1> free;
  // [truth][estimate], indexed by CellState.
  std::array<std::array<int, 3>, 3> confusion = {};
  // Matthews' correlation coefficient of "is occupied" and of "is free" with the truth, at
  // tolerance 0; empty when it is constant in either map.
  std::optional<double> occupied_mcc;
  std::optional<double> free_mcc;
  // Share of the scored cells with known truth that are known in the estimate; for the observable
  // score, share of all observable cells.
  std::optional<double> coverage;
  int scored_cells = 0;
};

struct MapScore {
  std::optional<CellScores> observable;  // empty without an observable set
  CellScores all;
  std::optional<MapQuality> quality;  // by ScoreMapQuality(); not set by ScoreMap()
  // Size of the compared cells, where one of the maps has smaller ones; not set by ScoreMap().
  std::optional<double> compared_cell_m;
};

// All three must have the same resolution.
MapScore ScoreMap(const StateMap& truth, const StateMap& estimate,
                  const std::optional<CellSet>& observable);

}  // namespace depthgrid
