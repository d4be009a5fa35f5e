// The finished map: every stored scan drawn at its final pose. Storage is by tiles of 64 x 64
// cells, made when a scan first touches them, so memory grows with the area seen.
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

class MapDrawing {
 public:
  explicit MapDrawing(const GridOptions& options);

  // Throws InputError when the map would have more than kMaxMapCells, before it takes memory for
  // them; so does Map() from then on.
  void Add(const Scan& scan, const Pose2& map_from_base);
  // Of a mapped frame of this number (MappedFrame::frame): where BeginsDrive(), it begins one.
  void Add(int frame, const Scan& scan, const Pose2& map_from_base);
  // What was added is of drives before the one whose scans come now (GridOptions::earlier_scans).
  void BeginDrive();
  // The smallest rectangle around all cells that were seen; empty when none was.
  OccupancyMap Map() const;

 private:
  struct CellRecord {
    std::uint32_t hits = 0;
    std::uint32_t passes = 0;
    int log_odds_units = 0;
    // How much of a surface the cell holds, and the same times the direction it was seen along.
    float surface = 0.0F;
    float surface_x = 0.0F;
    float surface_y = 0.0F;
  };
  // The most surface near a cell, and how many cells farther from the sensor it lies.
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
  Tiles earlier_tiles_;  // of the drives before
  int last_frame_ = 0;
};

}  // namespace depthgrid
