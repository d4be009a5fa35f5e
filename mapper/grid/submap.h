// Submaps: grids of a fixed number of scans, two of them active at a time (Hess et al. 2016).
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/grid/probability_grid.h"
#include "mapper/grid/wall_distances.h"

namespace depthgrid {

// How a submap computes cells near a wall.
enum class SubmapWalls {
  kCounted,   // clamped log-odds, as for all other cells
  kAveraged,  // by the mean distance of the cell to the hits
};

struct SubmapOptions {
  // A new submap starts every `scans` scans and receives twice as many: the first half while the
  // previous one is matched against, the second half while it is matched against itself.
  int scans = 90;  // Cartographer's; 3 s at 30 Hz
  SubmapWalls walls = SubmapWalls::kCounted;

  void Visit(OptionsVisitor& v);
};

// A grid that scans are matched against.
class Submap {
 public:
  Submap(const SubmapOptions& submap, const GridOptions& grid);

  // `cells` and `walls` of a scan at its pose; `walls` is empty with kCounted.
  void Insert(const ScanCells& cells, const std::vector<WallDistance>& walls);
  // NaN where nothing was seen. The reference stays good until the next insertion.
  const OccupancyMap& map();
  // Size in cells after inserting these.
  std::size_t SizeWith(const ScanCells& cells) const;

 private:
  ProbabilityGrid grid_;
  std::optional<WallDistances> walls_;
  OccupancyMap drawn_;  // with the walls; valid if is_drawn_
  bool is_drawn_ = false;
};

// The submaps that scans are inserted into: scan n goes into submap n / scans and the one before
// it.
class ActiveSubmaps {
 public:
  ActiveSubmaps(const SubmapOptions& submap, const GridOptions& grid)
      : submap_options_(submap), grid_options_(grid) {}

  // Puts the next scan into every active submap. If a submap would become too large, starts anew.
  void Insert(const ScanCells& cells, const Scan& scan, const Pose2& map_from_base);
  // Clears all and counts the next scan as number `scan_count`.
  void RestartAt(int scan_count);

  // The older one, which scans are matched against; null before the first scan.
  Submap* matching() { return submaps_.empty() ? nullptr : &submaps_.front(); }

 private:
  SubmapOptions submap_options_;
  GridOptions grid_options_;
  int scan_count_ = 0;
  std::deque<Submap> submaps_;  // at most two, the older one first
  WallMemory walls_;
};

}  // namespace depthgrid
