// The finished map: every stored scan drawn at its final pose. Storage is by tiles of 64 x 64
// cells, allocated on first use, so memory grows with the area seen.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "mapper/core/occupancy_map.h"
#include "mapper/grid/grid_options.h"
#include "mapper/grid/scan_rasterizer.h"

namespace depthgrid {

// A map can be drawn on: scans added later give what all of them added at once, in the same order,
// give. So a live map needs only the frames of CurrentMapped() that are new, until
// FrameReport::map_corrected says to begin again (docs/examples/live_mapper.cc).
class MapDrawing {
 public:
  explicit MapDrawing(const GridOptions& options);

  // Throws InputError, before allocating, when the map would have more than kMaxMapCells; so does
  // Map() from then on.
  void Add(const Scan& scan, const Pose2& map_from_base);
  // Adds the scan of a mapped frame (`frame`: MappedFrame::frame), which begins a drive where
  // BeginsDrive() holds.
  void Add(int frame, const Scan& scan, const Pose2& map_from_base);
  // Declares all scans added so far to be of earlier drives (GridOptions::earlier_scans).
  void BeginDrive();
  // The smallest rectangle around all cells that were seen; empty when none was.
  OccupancyMap Map() const;

 private:
  struct CellRecord {
    std::uint32_t hits = 0;
    std::uint32_t passes = 0;
    int log_odds_units = 0;
    // Amount of surface in the cell, and the same times the unit viewing direction.
    float surface = 0.0F;
    float surface_x = 0.0F;
    float surface_y = 0.0F;
  };
  // The largest surface near a cell, and its distance behind the cell along the view, in cells.
  struct Peak {
    float surface = 0.0F;
    int step = 0;
  };
  struct Tile {
    std::array<CellRecord, kWordCells * kWordCells> cells;  // row by row
  };
  using TileIndex = std::pair<int, int>;  // row, column: in units of 64 cells
  // Ordered: no result depends on addresses.
  using Tiles = std::map<TileIndex, std::unique_ptr<Tile>>;

  Tile& TileAt(const TileIndex& index);
  void AddMask(const CellMask& mask, bool hit);
  void AddSurface(const Scan& scan, const Pose2& map_from_base);
  void AddEarlier(Tiles& tiles) const;
  CellRecord Limited(const CellRecord& earlier) const;
  OccupancyMap MapOf(const Tiles& tiles) const;
  Peak PeakAlong(const Tiles& tiles, const Cell& cell, const CellRecord& record) const;
  void ThinWalls(const Tiles& tiles, OccupancyMap& map) const;
  float Probability(const CellRecord& cell) const;

  GridOptions options_;
  int hit_units_;
  int miss_units_;
  int min_units_;
  int max_units_;
  ScanRasterizer rasterizer_;
  GridGeometry seen_;  // the smallest rectangle around all cells that were seen
  Tiles tiles_;
  Tiles earlier_tiles_;  // of earlier drives
  int last_frame_ = 0;
};

}  // namespace depthgrid
