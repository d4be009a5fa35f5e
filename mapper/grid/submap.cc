#include "mapper/grid/submap.h"

#include <algorithm>

namespace depthgrid {
namespace {

// Limit of a submap's size: a square of 400 m in cells of 5 cm, or, with smaller cells, four times
// the scan's own rectangle, which is what a narrow view covers when turning on the spot. A pose
// beyond this is an outlier, or SLAM restarted elsewhere.
constexpr std::size_t kMostSubmapCells = std::size_t{1} << 26;
constexpr std::size_t kMostScans = 4;

std::size_t MostCellsWith(const ScanCells& cells) {
  return std::max(kMostSubmapCells, kMostScans * cells.hit.size());
}

}  // namespace

void SubmapOptions::Visit(OptionsVisitor& v) {
  v.Number("scans", scans, {1, 1e6}, "scans from the start of one submap to the next");
  v.Choice(
      "walls", walls, {{SubmapWalls::kCounted, "counted"}, {SubmapWalls::kAveraged, "averaged"}},
      "how cells near a wall are drawn: by hits and misses, or by their mean distance to the hits");
}

Submap::Submap(const SubmapOptions& submap, const GridOptions& grid) : grid_(grid) {
  if (submap.walls == SubmapWalls::kAveraged) {
    walls_.emplace(grid.resolution_m, grid.min_prob, grid.max_prob);
  }
}

void Submap::Insert(const ScanCells& cells, const std::vector<WallDistance>& walls) {
  grid_.Insert(cells);
  if (walls_) walls_->Insert(walls);
  is_drawn_ = false;
}

std::size_t Submap::SizeWith(const ScanCells& cells) const {
  return grid_.GeometryWith(cells.hit).size();
}

const OccupancyMap& Submap::map() {
  if (!walls_) return grid_.map();
  if (!is_drawn_) walls_->DrawOver(grid_.map(), drawn_);
  is_drawn_ = true;
  return drawn_;
}

void ActiveSubmaps::Insert(const ScanCells& cells, const Scan& scan, const Pose2& map_from_base) {
  const bool too_far = std::any_of(submaps_.begin(), submaps_.end(), [&](const Submap& submap) {
    return submap.SizeWith(cells) > MostCellsWith(cells);
  });
  if (too_far) submaps_.clear();
  if (scan_count_ % submap_options_.scans == 0 || submaps_.empty()) {
    if (submaps_.size() == 2) submaps_.pop_front();
    submaps_.emplace_back(submap_options_, grid_options_);
  }
  if (submap_options_.walls == SubmapWalls::kAveraged) {
    FindWallDistances(scan, map_from_base, grid_options_.resolution_m, walls_);
  }
  for (Submap& submap : submaps_) submap.Insert(cells, walls_.distances);
  ++scan_count_;
}

void ActiveSubmaps::RestartAt(int scan_count) {
  submaps_.clear();
  scan_count_ = scan_count;
}

}  // namespace depthgrid
