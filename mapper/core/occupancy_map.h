// A finished map: the occupancy probability of each cell, and its classification into three states.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "mapper/core/grid_geometry.h"

namespace depthgrid {

constexpr float kUnknownProb = std::numeric_limits<float>::quiet_NaN();

// A gigabyte of probabilities, 819 x 819 m at 5 cm: a larger map means a wrong pose or file rather
// than a large building, and is reported before memory runs out.
constexpr std::size_t kMaxMapCells = std::size_t{1} << 28U;

struct OccupancyMap {
  GridGeometry geometry;
  std::vector<float> occupied_prob;  // geometry.size(); NaN is "never seen"

  OccupancyMap() = default;
  explicit OccupancyMap(const GridGeometry& g)
      : geometry(g), occupied_prob(g.size(), kUnknownProb) {}
  // NaN outside the rectangle.
  float At(const Cell& cell) const {
    return geometry.Contains(cell) ? occupied_prob[geometry.Index(cell)] : kUnknownProb;
  }
};

enum class CellState : std::uint8_t { kUnknown = 0, kFree = 1, kOccupied = 2 };

// Nav2's rule: p > occupied is occupied, p < free is free, the rest (and NaN) unknown.
struct StateThresholds {
  double occupied_prob = 0.65;
  double free_prob = 0.196;  // below the 205/255 pixel's 0.1961, which means unknown
};

inline CellState StateOf(float occupied_prob, const StateThresholds& thresholds = {}) {
  if (occupied_prob > thresholds.occupied_prob) return CellState::kOccupied;
  if (occupied_prob < thresholds.free_prob) return CellState::kFree;
  return CellState::kUnknown;  // NaN compares false with both
}

struct StateMap {
  GridGeometry geometry;
  std::vector<CellState> states;  // geometry.size()

  StateMap() = default;
  explicit StateMap(const GridGeometry& g) : geometry(g), states(g.size(), CellState::kUnknown) {}
  // kUnknown outside the rectangle.
  CellState At(const Cell& cell) const {
    return geometry.Contains(cell) ? states[geometry.Index(cell)] : CellState::kUnknown;
  }
  bool operator==(const StateMap&) const = default;
};

// Probability 1 where occupied, 0 where free, NaN where unknown.
OccupancyMap CertainMap(const StateMap& map);

StateMap StatesOf(const OccupancyMap& map);

// The smallest rectangle around all cells whose probability differs between two drawings of a map,
// cells outside of one being unknown in it; empty when none does. Both of one resolution.
GridGeometry ChangedBetween(const OccupancyMap& before, const OccupancyMap& after);

}  // namespace depthgrid
