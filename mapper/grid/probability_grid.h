// The grid that scans are matched against: clamped log-odds per cell, also as probabilities.
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

  // Adds one update to every cell of the masks; grows as needed.
  void Insert(const ScanCells& cells);

  // NaN where nothing was seen. Probabilities of changed cells are updated only here, so grids that
  // are not read cost nothing. The reference stays valid; its rectangle and buffer may change with
  // each insertion.
  const OccupancyMap& map();

  // A rectangle that contains the grid after inserting this mask.
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
  // Parallel to map_.occupied_prob. 0 until a cell is seen.
  std::vector<std::int16_t> log_odds_units_;
  std::vector<std::uint64_t> changed_;  // bits of cells whose probability is out of date
};

}  // namespace depthgrid
