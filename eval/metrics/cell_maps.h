// Maps resampled to one geometry, and sets of cells in them.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// The same cells on another rectangle; cells that were outside are unknown, or not members.
StateMap OnGeometry(const StateMap& map, const GridGeometry& geometry);
CellSet OnGeometry(const CellSet& set, const GridGeometry& geometry);

// The map in cells of `resolution_m`, `times` as large as its own: occupied if any of its cells in
// them is occupied, else free if any is free.
StateMap Coarsened(const StateMap& map, int times, double resolution_m);

CellSet CellsIn(const StateMap& map, CellState state);
CellSet KnownCells(const StateMap& map);
// Of one geometry.
CellSet InBoth(CellSet a, const CellSet& b);

// Truth and estimate on the rectangle that holds both, with the cells to be scored: the observable
// ones or, without an observable set, those whose truth is known.
struct ScoredMaps {
  StateMap truth;
  StateMap estimate;
  CellSet scored;
};
ScoredMaps OnOneGeometry(const StateMap& truth, const StateMap& estimate,
                         const std::optional<CellSet>& observable);

// Cells of one kind, such as walls, in both maps, and those to be scored. Refers to them.
struct ScoredCells {
  const CellSet& truth;
  const CellSet& estimate;
  const CellSet& scored;
};

// Cell centres in metres, in the order of the cells.
std::vector<Eigen::Vector2d> CentresOf(const CellSet& set);

// Tolerance for limits on the distance between centres: even a whole number of cells has a rounding
// error.
constexpr double kCentreSlackM = 1e-6;

std::optional<double> Ratio(double part, double whole);  // empty when the whole is not positive
std::optional<double> F1Of(const std::optional<double>& precision,
                           const std::optional<double>& recall);

}  // namespace depthgrid
