#include "mapper/grid/probability_grid.h"

#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "mapper/grid/log_odds.h"

namespace depthgrid {
namespace {

// The rectangle grows by at least this much, so that a moving camera seldom causes it to grow.
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

std::int16_t Units(double prob) { return static_cast<std::int16_t>(LogOddsUnits(prob)); }

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<std::int16_t, 16>;
constexpr Lanes kLanes;

// `value` in the lanes whose bit is set.
hn::Vec<Lanes> WhereSet(std::uint64_t bits, std::int16_t value) {
  const hn::Vec<Lanes> lane_bit = hn::Shl(hn::Set(kLanes, std::int16_t{1}), hn::Iota(kLanes, 0));
  const hn::Vec<Lanes> here = hn::And(hn::Set(kLanes, static_cast<std::int16_t>(bits)), lane_bit);
  return hn::IfThenElseZero(hn::Eq(here, lane_bit), hn::Set(kLanes, value));
}

}  // namespace

ProbabilityGrid::ProbabilityGrid(const GridOptions& options)
    : hit_units_(Units(options.hit_prob)),
      miss_units_(Units(options.miss_prob)),
      min_units_(Units(options.min_prob)),
      max_units_(Units(options.max_prob)) {
  map_.geometry.resolution_m = options.resolution_m;
  for (int units = min_units_; units <= max_units_; ++units) {
    prob_of_units_.push_back(static_cast<float>(ProbabilityFromLogOdds(units * kLogOddsUnit)));
  }
}

void ProbabilityGrid::Insert(const ScanCells& cells) {
  GrowToContain(cells.hit);
  for (int y = cells.hit.first_row(); y < cells.hit.first_row() + cells.hit.rows(); ++y) {
    const std::uint64_t* const hit = cells.hit.Row(y);
    const std::uint64_t* const passed = cells.passed.Row(y);
    const std::size_t first = WordIndex(y, cells.hit.first_word());
    for (int word = 0; word < cells.hit.words_per_row(); ++word) {
      if ((hit[word] | passed[word]) == 0) continue;
      AddToWord(hit[word], passed[word], first + static_cast<std::size_t>(word));
    }
  }
}

// Cells that neither mask has keep their value: it lies between the clamps, or is 0.
void ProbabilityGrid::AddToWord(std::uint64_t hit, std::uint64_t passed, std::size_t index) {
  changed_[index] |= hit | passed;
  std::int16_t* units = log_odds_units_.data() + index * kWordCells;
  const hn::Vec<Lanes> low = hn::Set(kLanes, min_units_);
  const hn::Vec<Lanes> high = hn::Set(kLanes, max_units_);
  const int lanes = static_cast<int>(hn::Lanes(kLanes));
  for (int i = 0; i < kWordCells; i += lanes) {
    const hn::Vec<Lanes> step =
        hn::Or(WhereSet(hit >> i, hit_units_), WhereSet(passed >> i, miss_units_));
    const hn::Vec<Lanes> sum = hn::Add(hn::LoadU(kLanes, units + i), step);
    hn::StoreU(hn::Max(low, hn::Min(high, sum)), kLanes, units + i);
  }
}

std::size_t ProbabilityGrid::WordIndex(int y, int word) const {
  return map_.geometry.Index({word * kWordCells, y}) / kWordCells;
}

namespace {

GridGeometry GeometryOf(const CellMask& mask, double resolution_m) {
  return {resolution_m,
          {mask.first_word() * kWordCells, mask.first_row()},
          mask.words_per_row() * kWordCells,
          mask.rows()};
}

}  // namespace

GridGeometry ProbabilityGrid::GeometryWith(const CellMask& mask) const {
  return Union(map_.geometry, GeometryOf(mask, map_.geometry.resolution_m));
}

void ProbabilityGrid::GrowToContain(const CellMask& mask) {
  GridGeometry needed = GeometryOf(mask, map_.geometry.resolution_m);
  if (Union(map_.geometry, needed) == map_.geometry) return;
  map();  // brings all cells up to date before they move
  needed.min_cell.y -= kGrowthCells;
  needed.height_cells += 2 * kGrowthCells;
  const GridGeometry grown = Union(map_.geometry, needed);
  log_odds_units_ = Moved<std::int16_t>(log_odds_units_, map_.geometry, grown, 0);
  map_.occupied_prob = Moved(map_.occupied_prob, map_.geometry, grown, kUnknownProb);
  map_.geometry = grown;
  changed_.assign(grown.size() / kWordCells, 0);
}

const OccupancyMap& ProbabilityGrid::map() {
  const float* const prob_of_units = prob_of_units_.data() - min_units_;
  for (std::size_t index = 0; index < changed_.size(); ++index) {
    if (changed_[index] == 0) continue;
    const std::int16_t* const units = log_odds_units_.data() + index * kWordCells;
    float* const prob = map_.occupied_prob.data() + index * kWordCells;
    if (changed_[index] == ~std::uint64_t{0}) {
      for (int i = 0; i < kWordCells; ++i) prob[i] = prob_of_units[units[i]];
    } else {
      for (std::uint64_t bits = changed_[index]; bits != 0; bits &= bits - 1) {
        const int i = std::countr_zero(bits);
        prob[i] = prob_of_units[units[i]];
      }
    }
    changed_[index] = 0;
  }
  return map_;
}

}  // namespace depthgrid
