#include "mapper/grid/submap.h"

namespace depthgrid {

void SubmapOptions::Visit(OptionsVisitor& v) {
  v.Number("scans", scans, {1, 1e6}, "a submap starts every so many scans");
}

void ActiveSubmaps::Insert(const ScanCells& cells) {
  if (scan_count_ % submap_options_.scans == 0 || grids_.empty()) {
    if (grids_.size() == 2) grids_.pop_front();
    grids_.emplace_back(grid_options_);
  }
  for (ProbabilityGrid& grid : grids_) grid.Insert(cells);
  ++scan_count_;
}

void ActiveSubmaps::RestartAt(int scan_count) {
  grids_.clear();
  scan_count_ = scan_count;
}

}  // namespace depthgrid
