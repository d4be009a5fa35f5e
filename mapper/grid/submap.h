// Submaps: grids of a fixed number of scans, two of them active at a time (Hess et al. 2016).
#pragma once

#include <deque>

#include "mapper/core/options.h"
#include "mapper/grid/probability_grid.h"

namespace depthgrid {

struct SubmapOptions {
  // A new submap starts every so many scans and takes twice as many: the first half while the one
  // before it is matched against, the second half while it is matched against itself.
  int scans = 90;  // Cartographer's; 3 s at 30 Hz

  void Visit(OptionsVisitor& v);
};

// Which submaps the n-th scan goes into: n / scans and the one before it.
class ActiveSubmaps {
 public:
  ActiveSubmaps(const SubmapOptions& submap, const GridOptions& grid)
      : submap_options_(submap), grid_options_(grid) {}

  // Puts the next scan into every active submap.
  void Insert(const ScanCells& cells);
  // Forgets everything and counts the next scan as the n-th.
  void RestartAt(int scan_count);

  // The older one, which scans are matched against; null before the first scan.
  ProbabilityGrid* matching() { return grids_.empty() ? nullptr : &grids_.front(); }

 private:
  SubmapOptions submap_options_;
  GridOptions grid_options_;
  int scan_count_ = 0;
  std::deque<ProbabilityGrid> grids_;  // at most two, the older one first
};

}  // namespace depthgrid
