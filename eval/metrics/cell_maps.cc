#include "eval/metrics/cell_maps.h"

#include <algorithm>

namespace depthgrid {

StateMap OnGeometry(const StateMap& map, const GridGeometry& geometry) {
  StateMap moved(geometry);
  for (std::size_t i = 0; i < geometry.size(); ++i) moved.states[i] = map.At(geometry.CellAt(i));
  return moved;
}

CellSet OnGeometry(const CellSet& set, const GridGeometry& geometry) {
  CellSet moved(geometry);
  for (std::size_t i = 0; i < geometry.size(); ++i) {
    moved.members[i] = set.Has(geometry.CellAt(i)) ? 1 : 0;
  }
  return moved;
}

StateMap Coarsened(const StateMap& map, int times, double resolution_m) {
  const GridGeometry& fine = map.geometry;
  const auto coarse_of = [times](const Cell& cell) {
    const auto index = [times](int i) { return i >= 0 ? i / times : -((times - 1 - i) / times); };
    return Cell{index(cell.x), index(cell.y)};
  };
  const Cell min_cell = coarse_of(fine.min_cell);
  const Cell max_cell =
      coarse_of({fine.min_cell.x + fine.width_cells - 1, fine.min_cell.y + fine.height_cells - 1});
  StateMap coarse(GridGeometry{resolution_m, min_cell, max_cell.x - min_cell.x + 1,
                               max_cell.y - min_cell.y + 1});
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    CellState& state = coarse.states[coarse.geometry.Index(coarse_of(fine.CellAt(i)))];
    state = std::max(state, map.states[i]);  // in the order unknown < free < occupied
  }
  return coarse;
}

CellSet CellsIn(const StateMap& map, CellState state) {
  CellSet set(map.geometry);
  for (std::size_t i = 0; i < map.states.size(); ++i) set.members[i] = map.states[i] == state;
  return set;
}

CellSet KnownCells(const StateMap& map) {
  CellSet set(map.geometry);
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    set.members[i] = map.states[i] != CellState::kUnknown;
  }
  return set;
}

ScoredMaps OnOneGeometry(const StateMap& truth, const StateMap& estimate,
                         const std::optional<CellSet>& observable) {
  GridGeometry geometry = Union(truth.geometry, estimate.geometry);
  if (observable) geometry = Union(geometry, observable->geometry);
  ScoredMaps maps;
  maps.truth = OnGeometry(truth, geometry);
  maps.estimate = OnGeometry(estimate, geometry);
  maps.scored = observable ? OnGeometry(*observable, geometry) : KnownCells(maps.truth);
  return maps;
}

CellSet InBoth(CellSet a, const CellSet& b) {
  for (std::size_t i = 0; i < a.members.size(); ++i) a.members[i] &= b.members[i];
  return a;
}

std::vector<Eigen::Vector2d> CentresOf(const CellSet& set) {
  std::vector<Eigen::Vector2d> centres;
  for (std::size_t i = 0; i < set.members.size(); ++i) {
    if (set.members[i] == 0) continue;
    centres.push_back(CellCentre(set.geometry.CellAt(i), set.geometry.resolution_m));
  }
  return centres;
}

std::optional<double> Ratio(double part, double whole) {
  if (!(whole > 0.0)) return std::nullopt;
  return part / whole;
}

std::optional<double> F1Of(const std::optional<double>& precision,
                           const std::optional<double>& recall) {
  if (!precision || !recall) return std::nullopt;
  const double sum = *precision + *recall;
  return sum > 0.0 ? 2.0 * *precision * *recall / sum : 0.0;
}

}  // namespace depthgrid
