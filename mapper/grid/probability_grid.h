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

  // NaN where nothing was seen. The reference stays good, its rectangle and buffer may change with
  // every insertion.
  const OccupancyMap& map() const { return map_; }

 private:
  void GrowToContain(const CellMask& mask);
  void Add(const CellMask& mask, int step_units);

  int hit_units_ = 0;
  int miss_units_ = 0;
  int min_units_ = 0;
  int max_units_ = 0;
  std::vector<float> prob_of_units_;  // from min_units_ on
  OccupancyMap map_;
  std::vector<std::int16_t> log_odds_units_;  // beside map_.occupied_prob
};

}  // namespace depthgrid
