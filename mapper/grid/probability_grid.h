// The grid scans are matched against: clamped log-odds of every cell, and the same as
// probabilities.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/occupancy_map.h"
#include "mapper/grid/grid_options.h"
#include "mapper/grid/scan_cells.h"

namespace depthgrid {

class ProbabilityGrid {
 public:
  explicit ProbabilityGrid(const GridOptions& options);

  // Adds one update to every cell of the masks; grows as needed and loses nothing.
  void Insert(const ScanCells& cells);

  // NaN where nothing was seen. Brings the probabilities of cells that changed up to date: a grid
  // that nobody looks at does not pay for them. The reference stays good, its rectangle and buffer
  // may change with every insertion.
  const OccupancyMap& map();

  // At least the rectangle that it grows to when this is inserted.
  GridGeometry GeometryWith(const CellMask& mask) const;

 private:
  void GrowToContain(const CellMask& mask);
  void AddToWord(std::uint64_t hit, std::uint64_t passed, std::size_t index);
  std::size_t WordIndex(int y, int word) const;

  std::int16_t hit_units_;  // of kLogOddsUnit; the options' ranges keep sums within 16 bits
  std::int16_t miss_units_;
  std::int16_t min_units_;
  std::int16_t max_units_;
  std::vector<float> prob_of_units_;  // from min_units_ on
  OccupancyMap map_;                  // its rows are whole words of 64 cells
  // Beside map_.occupied_prob. 0 until a cell is seen: indifferent.
  std::vector<std::int16_t> log_odds_units_;
  std::vector<std::uint64_t> changed_;  // bits of cells whose probability is out of date
};

}  // namespace depthgrid
