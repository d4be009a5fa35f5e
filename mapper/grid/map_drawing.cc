#include "mapper/grid/map_drawing.h"

#include <algorithm>
#include <bit>

#include "mapper/grid/log_odds.h"

namespace depthgrid {

MapDrawing::MapDrawing(const GridOptions& options)
    : options_(options),
      hit_units_(LogOddsUnits(options.hit_prob)),
      miss_units_(LogOddsUnits(options.miss_prob)),
      min_units_(LogOddsUnits(options.min_prob)),
      max_units_(LogOddsUnits(options.max_prob)) {}

void MapDrawing::Add(const Scan& scan, const Pose2& map_from_base) {
  const double clear_margin_m = options_.clear_margin_cells * options_.resolution_m;
  const ScanCells& cells =
      rasterizer_.Rasterize(scan, map_from_base, options_.resolution_m, clear_margin_m);
  AddMask(cells.hit, true);
  AddMask(cells.passed, false);
}

MapDrawing::Tile& MapDrawing::TileAt(const TileIndex& index) {
  std::unique_ptr<Tile>& tile = tiles_[index];
  if (!tile) tile = std::make_unique<Tile>();
  return *tile;
}

void MapDrawing::AddMask(const CellMask& mask, bool hit) {
  const int step_units = hit ? hit_units_ : miss_units_;
  for (int y = mask.first_row(); y < mask.first_row() + mask.rows(); ++y) {
    for (int word = 0; word < mask.words_per_row(); ++word) {
      std::uint64_t bits = mask.Row(y)[word];
      if (bits == 0) continue;
      Tile& tile = TileAt({WordOf(y), mask.first_word() + word});
      CellRecord* row = tile.cells.data() + (y & (kWordCells - 1)) * kWordCells;
      for (; bits != 0; bits &= bits - 1) {
        CellRecord& cell = row[std::countr_zero(bits)];
        ++(hit ? cell.hits : cell.passes);
        cell.log_odds_units = std::clamp(cell.log_odds_units + step_units, min_units_, max_units_);
      }
    }
  }
}

float MapDrawing::Probability(const CellRecord& cell) const {
  const std::uint32_t seen = cell.hits + cell.passes;
  if (seen == 0) return kUnknownProb;
  if (options_.raster == RasterRule::kLogOdds) {
    return static_cast<float>(ProbabilityFromLogOdds(cell.log_odds_units * kLogOddsUnit));
  }
  if (seen < static_cast<std::uint32_t>(options_.min_observations)) return kUnknownProb;
  const double weighted_hits = options_.hit_weight * cell.hits;
  return static_cast<float>(weighted_hits / (weighted_hits + cell.passes));
}

GridGeometry MapDrawing::SeenRectangle() const {
  GridGeometry seen;
  seen.resolution_m = options_.resolution_m;
  for (const auto& [index, tile] : tiles_) {
    for (int i = 0; i < kWordCells * kWordCells; ++i) {
      const CellRecord& cell = tile->cells[static_cast<std::size_t>(i)];
      if (cell.hits + cell.passes == 0) continue;
      GridGeometry one = seen;
      one.min_cell = {index.second * kWordCells + i % kWordCells,
                      index.first * kWordCells + i / kWordCells};
      one.width_cells = one.height_cells = 1;
      seen = Union(seen, one);
    }
  }
  return seen;
}

OccupancyMap MapDrawing::Map() const {
  OccupancyMap map(SeenRectangle());
  for (const auto& [index, tile] : tiles_) {
    for (int i = 0; i < kWordCells * kWordCells; ++i) {
      const Cell cell{index.second * kWordCells + i % kWordCells,
                      index.first * kWordCells + i / kWordCells};
      if (!map.geometry.Contains(cell)) continue;
      map.occupied_prob[map.geometry.Index(cell)] =
          Probability(tile->cells[static_cast<std::size_t>(i)]);
    }
  }
  return map;
}

}  // namespace depthgrid
