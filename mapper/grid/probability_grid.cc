#include "mapper/grid/probability_grid.h"

#include <algorithm>
#include <bit>

#include "mapper/grid/log_odds.h"

namespace depthgrid {
namespace {

// The rectangle grows by at least this much at a time, so that a moving camera seldom makes it
// grow.
constexpr int kGrowthCells = 32;

template <typename Value>
std::vector<Value> Moved(const std::vector<Value>& values, const GridGeometry& from,
                         const GridGeometry& to, Value fill) {
  std::vector<Value> moved(to.size(), fill);
  for (int row = 0; row < from.height_cells; ++row) {
    const Cell first{from.min_cell.x, from.min_cell.y + row};
    const auto source = values.begin() + static_cast<std::ptrdiff_t>(from.Index(first));
    std::copy(source, source + from.width_cells,
              moved.begin() + static_cast<std::ptrdiff_t>(to.Index(first)));
  }
  return moved;
}

}  // namespace

ProbabilityGrid::ProbabilityGrid(const GridOptions& options)
    : hit_units_(LogOddsUnits(options.hit_prob)),
      miss_units_(LogOddsUnits(options.miss_prob)),
      min_units_(LogOddsUnits(options.min_prob)),
      max_units_(LogOddsUnits(options.max_prob)) {
  map_.geometry.resolution_m = options.resolution_m;
  for (int units = min_units_; units <= max_units_; ++units) {
    prob_of_units_.push_back(static_cast<float>(ProbabilityFromLogOdds(units * kLogOddsUnit)));
  }
}

void ProbabilityGrid::Insert(const ScanCells& cells) {
  GrowToContain(cells.hit);
  Add(cells.hit, hit_units_);
  Add(cells.passed, miss_units_);
}

void ProbabilityGrid::GrowToContain(const CellMask& mask) {
  GridGeometry needed = map_.geometry;
  needed.min_cell = {mask.first_word() * kWordCells, mask.first_row()};
  needed.width_cells = mask.words_per_row() * kWordCells;
  needed.height_cells = mask.rows();
  if (Union(map_.geometry, needed) == map_.geometry) return;
  needed.min_cell.y -= kGrowthCells;
  needed.height_cells += 2 * kGrowthCells;
  const GridGeometry grown = Union(map_.geometry, needed);
  log_odds_units_ = Moved<std::int16_t>(log_odds_units_, map_.geometry, grown, 0);
  map_.occupied_prob = Moved(map_.occupied_prob, map_.geometry, grown, kUnknownProb);
  map_.geometry = grown;
}

void ProbabilityGrid::Add(const CellMask& mask, int step_units) {
  for (int y = mask.first_row(); y < mask.first_row() + mask.rows(); ++y) {
    for (int word = 0; word < mask.words_per_row(); ++word) {
      const std::size_t first = map_.geometry.Index({(mask.first_word() + word) * kWordCells, y});
      for (std::uint64_t bits = mask.Row(y)[word]; bits != 0; bits &= bits - 1) {
        const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(bits));
        const int units = std::clamp(log_odds_units_[i] + step_units, min_units_, max_units_);
        log_odds_units_[i] = static_cast<std::int16_t>(units);
        map_.occupied_prob[i] = prob_of_units_[static_cast<std::size_t>(units - min_units_)];
      }
    }
  }
}

}  // namespace depthgrid
