#include "mapper/grid/map_drawing.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "mapper/core/drives.h"
#include "mapper/core/error.h"
#include "mapper/grid/log_odds.h"

namespace depthgrid {
namespace {

// The global index of cell `i` of a tile.
Cell CellOfTile(int tile_row, int tile_column, int i) {
  return {tile_column * kWordCells + i % kWordCells, tile_row * kWordCells + i / kWordCells};
}

std::size_t CellInTile(const Cell& cell) {
  return static_cast<std::size_t>((cell.y & (kWordCells - 1)) * kWordCells +
                                  (cell.x & (kWordCells - 1)));
}

void RequireDrawable(const GridGeometry& seen) {
  if (seen.size() <= kMaxMapCells) return;
  const auto metres = [&](int cells) {
    return std::to_string(std::llround(cells * seen.resolution_m)) + " m";
  };
  throw InputError("map", "spans " + metres(seen.width_cells) + " x " + metres(seen.height_cells) +
                              ", " + std::to_string(seen.size()) + " cells, at most " +
                              std::to_string(kMaxMapCells) +
                              ": a pose lies far off, or the resolution is too fine");
}

// The record of a cell; null where there is no tile.
template <typename Tiles>
auto RecordIn(const Tiles& tiles, const Cell& cell)
    -> decltype(tiles.begin()->second->cells.data()) {
  const auto tile = tiles.find({WordOf(cell.y), WordOf(cell.x)});
  return tile == tiles.end() ? nullptr : &tile->second->cells[CellInTile(cell)];
}

// The bounding rectangle of the mask's cells; empty for none.
GridGeometry RectangleOf(const CellMask& mask, double resolution_m) {
  constexpr int kNone = std::numeric_limits<int>::max();
  int low_x = kNone, end_x = -kNone, low_y = kNone, end_y = -kNone;
  for (int y = mask.first_row(); y < mask.first_row() + mask.rows(); ++y) {
    const std::uint64_t* row = mask.Row(y);
    int first = 0;
    int last = mask.words_per_row() - 1;
    while (first <= last && row[first] == 0) ++first;
    if (first > last) continue;
    while (row[last] == 0) --last;
    const int first_x = (mask.first_word() + first) * kWordCells + std::countr_zero(row[first]);
    const int last_end = (mask.first_word() + last + 1) * kWordCells - std::countl_zero(row[last]);
    low_x = std::min(low_x, first_x);
    end_x = std::max(end_x, last_end);
    low_y = std::min(low_y, y);
    end_y = y + 1;
  }
  if (low_x == kNone) return {resolution_m, {}, 0, 0};
  return {resolution_m, {low_x, low_y}, end_x - low_x, end_y - low_y};
}

}  // namespace

MapDrawing::MapDrawing(const GridOptions& options)
    : options_(options),
      hit_units_(LogOddsUnits(options.hit_prob)),
      miss_units_(LogOddsUnits(options.miss_prob)),
      min_units_(LogOddsUnits(options.min_prob)),
      max_units_(LogOddsUnits(options.max_prob)) {
  seen_.resolution_m = options.resolution_m;
}

void MapDrawing::Add(const Scan& scan, const Pose2& map_from_base) {
  const double clear_margin_m = options_.clear_margin_cells * options_.resolution_m;
  const ScanCells& cells =
      rasterizer_.Rasterize(scan, map_from_base, options_.resolution_m, clear_margin_m);
  for (const CellMask* mask : {&cells.hit, &cells.passed}) {
    seen_ = Union(seen_, RectangleOf(*mask, options_.resolution_m));
  }
  RequireDrawable(seen_);
  AddMask(cells.hit, true);
  AddMask(cells.passed, false);
  if (options_.min_surface_share > 0.0) AddSurface(scan, map_from_base);
}

// A beam represents the length of wall between it and its neighbour, at most a cell, weighted by
// the accuracy of its range: sigma grows at least with r.
void MapDrawing::AddSurface(const Scan& scan, const Pose2& map_from_base) {
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const Beam& beam = scan.beams[i];
    if (!beam.hit) continue;
    const Beam& neighbour = scan.beams[i > 0 ? i - 1 : std::min(i + 1, scan.beams.size() - 1)];
    const double range_m = beam.range_m;
    const double length_cells =
        range_m * std::abs(beam.bearing_rad - neighbour.bearing_rad) / options_.resolution_m;
    const auto surface =
        static_cast<float>(std::min(length_cells, 1.0) / std::max(range_m * range_m, 1.0));
    const Eigen::Vector2d point = map_from_base * EndPoint(beam);
    const Eigen::Vector2d direction = (point - map_from_base.translation()) / range_m;
    const Cell cell = CellOf(point, options_.resolution_m);
    CellRecord& record = TileAt({WordOf(cell.y), WordOf(cell.x)}).cells[CellInTile(cell)];
    record.surface += surface;
    record.surface_x += surface * static_cast<float>(direction.x());
    record.surface_y += surface * static_cast<float>(direction.y());
  }
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

// The record scaled down to at most options_.earlier_scans scans.
MapDrawing::CellRecord MapDrawing::Limited(const CellRecord& earlier) const {
  const std::uint32_t seen = earlier.hits + earlier.passes;
  const auto most = static_cast<std::uint32_t>(options_.earlier_scans);
  if (seen <= most) return earlier;
  const double share = static_cast<double>(most) / seen;
  CellRecord record = earlier;
  record.hits = static_cast<std::uint32_t>(std::lround(share * earlier.hits));
  record.passes = most - record.hits;
  for (float* part : {&record.surface, &record.surface_x, &record.surface_y}) {
    *part *= static_cast<float>(share);
  }
  return record;
}

// Adds earlier drives' records: with limited weight where this drive saw the cell, in full
// elsewhere.
void MapDrawing::AddEarlier(Tiles& tiles) const {
  for (const auto& [index, tile] : earlier_tiles_) {
    std::unique_ptr<Tile>& both = tiles[index];
    if (!both) both = std::make_unique<Tile>();
    for (std::size_t i = 0; i < tile->cells.size(); ++i) {
      CellRecord& cell = both->cells[i];
      const bool seen_now = cell.hits + cell.passes > 0;
      const CellRecord earlier = seen_now ? Limited(tile->cells[i]) : tile->cells[i];
      cell.hits += earlier.hits;
      cell.passes += earlier.passes;
      cell.surface += earlier.surface;
      cell.surface_x += earlier.surface_x;
      cell.surface_y += earlier.surface_y;
    }
  }
}

void MapDrawing::Add(int frame, const Scan& scan, const Pose2& map_from_base) {
  if (BeginsDrive(std::exchange(last_frame_, frame), frame)) BeginDrive();
  Add(scan, map_from_base);
}

void MapDrawing::BeginDrive() {
  // Log odds are clamped, so they adapt to changes without this.
  if (options_.earlier_scans == 0 || options_.raster == RasterRule::kLogOdds) return;
  AddEarlier(tiles_);
  earlier_tiles_ = std::exchange(tiles_, {});
}

OccupancyMap MapDrawing::Map() const {
  RequireDrawable(seen_);
  if (earlier_tiles_.empty()) return MapOf(tiles_);
  Tiles all;
  for (const auto& [index, tile] : tiles_) all[index] = std::make_unique<Tile>(*tile);
  AddEarlier(all);
  return MapOf(all);
}

OccupancyMap MapDrawing::MapOf(const Tiles& tiles) const {
  OccupancyMap map(seen_);
  for (const auto& [index, tile] : tiles) {
    for (int i = 0; i < kWordCells * kWordCells; ++i) {
      const Cell cell = CellOfTile(index.first, index.second, i);
      if (!map.geometry.Contains(cell)) continue;
      map.occupied_prob[map.geometry.Index(cell)] =
          Probability(tile->cells[static_cast<std::size_t>(i)]);
    }
  }
  if (options_.min_surface_share > 0.0) ThinWalls(tiles, map);
  return map;
}

// The largest surface value in front of and behind a cell along its viewing direction, where beams
// that ended here would have ended with different noise.
MapDrawing::Peak MapDrawing::PeakAlong(const Tiles& tiles, const Cell& cell,
                                       const CellRecord& record) const {
  Peak peak{record.surface, 0};
  const float longer = std::max(std::abs(record.surface_x), std::abs(record.surface_y));
  if (longer == 0.0F) return peak;
  const float step_x = record.surface_x / longer;
  const float step_y = record.surface_y / longer;
  const int reach =
      static_cast<int>(std::lround(options_.surface_radius_m / options_.resolution_m));
  for (int step = -reach; step <= reach; ++step) {
    const auto along = static_cast<float>(step);
    const CellRecord* other =
        RecordIn(tiles, {cell.x + static_cast<int>(std::lround(along * step_x)),
                         cell.y + static_cast<int>(std::lround(along * step_y))});
    if (other != nullptr && other->surface > peak.surface) peak = {other->surface, step};
  }
  return peak;
}

// A cell next to a surface peak with little surface of its own keeps only its passes. Behind the
// surface it takes many passes to make a cell free, as some beams pass it because of their noise.
void MapDrawing::ThinWalls(const Tiles& tiles, OccupancyMap& map) const {
  for (std::size_t i = 0; i < map.occupied_prob.size(); ++i) {
    if (!(map.occupied_prob[i] > 0.0F)) continue;
    const Cell cell = map.geometry.CellAt(i);
    const CellRecord& record = *RecordIn(tiles, cell);
    const Peak peak = PeakAlong(tiles, cell, record);
    if (record.surface >= options_.min_surface_share * peak.surface) continue;
    const bool is_behind = peak.step < 0;
    const double needed = record.hits * (is_behind ? options_.hit_weight : 1.0);
    map.occupied_prob[i] = record.passes > needed ? 0.0F : kUnknownProb;
  }
}

}  // namespace depthgrid
