#include "mapper/match/lattice_scorer.h"

#include <algorithm>
#include <cstring>

#include "mapper/match/reached_cells.h"

namespace depthgrid {
namespace {

// The sum of 64 quantised probabilities is below 2^16.
constexpr int kBlock = 64;
static_assert(kBlock * kMatchProbScale < (1 << 16));

constexpr int kColumns = 8;   // translations in x per load
constexpr int kMaxPairs = 6;  // row pairs summed at once; the sums stay in registers

// 8 columns of 2 rows, interleaved.
using Lanes = std::uint16_t __attribute__((vector_size(32)));

// Adds kPairs row pairs of 8 columns for every point of a block to 32-bit sums.
template <int kPairs>
void AddSquares(const std::uint32_t* row_pairs, int row_of_map, const int* cells, int count,
                std::uint32_t* sums, std::size_t row_of_sums) {
  Lanes block[kPairs] = {};
  for (int i = 0; i < count; ++i) {
    const std::uint32_t* corner = row_pairs + cells[i];
    for (int pair = 0; pair < kPairs; ++pair) {
      Lanes lanes;
      std::memcpy(&lanes, corner + 2 * pair * row_of_map, sizeof lanes);
      block[pair] += lanes;
    }
  }
  for (int pair = 0; pair < kPairs; ++pair) {
    std::uint32_t* low = sums + static_cast<std::size_t>(2 * pair) * row_of_sums;
    std::uint32_t* high = low + row_of_sums;
    for (int column = 0; column < kColumns; ++column) {
      low[column] += block[pair][2 * column];
      high[column] += block[pair][2 * column + 1];
    }
  }
}

using AddSquaresFunction = decltype(&AddSquares<1>);
constexpr AddSquaresFunction kAddSquares[kMaxPairs + 1] = {
    nullptr,       AddSquares<1>, AddSquares<2>, AddSquares<3>,
    AddSquares<4>, AddSquares<5>, AddSquares<6>};

int RoundUp(int value, int step) { return (value + step - 1) / step * step; }

// Quantises one row and returns its largest value. A separate function so that the compiler need
// not assume aliasing.
std::uint32_t QuantiseRow(const float* probs, int count, float unknown_prob,
                          std::uint32_t* quantised) {
  std::uint32_t largest = 0;
  for (int i = 0; i < count; ++i) {
    const float prob = probs[i] == probs[i] ? probs[i] : unknown_prob;
    quantised[i] = static_cast<std::uint32_t>(QuantisedProb(prob));
    largest = std::max(largest, quantised[i]);
  }
  return largest;
}

// Stores the row above in the high halves.
void PairRows(const std::uint32_t* above, std::size_t count, std::uint32_t* row) {
  for (std::size_t i = 0; i < count; ++i) row[i] |= above[i] << 16;
}

}  // namespace

void LatticeScorer::Prepare(const SearchLattice& lattice, const MatchPoints& points,
                            const ProbabilityView& view) {
  lattice_ = lattice;
  CopyPoints(points);
  const int side = 2 * lattice.half_cells + 1;
  // A rotation moves the farthest point by less than its arc; one more cell for rounding. Points
  // beyond the map by more than one square reach only unknown cells.
  const double turn_rad = std::min(2.0, lattice.half_yaw_steps * lattice.yaw_step_rad);
  const int turn_cells = static_cast<int>(turn_rad * points.farthest_m / lattice.resolution_m) + 2;
  copied_ = ReachedCells(points, lattice.CellsAt(0), turn_cells + lattice.half_cells, view.geometry,
                         side);
  row_of_map_ = RoundUp(copied_.width_cells + kColumns, kColumns);
  CopyMap(view);
  row_of_sums_ = static_cast<std::size_t>(RoundUp(side, kColumns));
  sums_.resize(row_of_sums_ * static_cast<std::size_t>(side + 1));
  cell_of_point_.resize(kBlock);
}

void LatticeScorer::CopyPoints(const MatchPoints& points) {
  points_ = points.size();
  const auto size = static_cast<std::size_t>(points_);
  x_m_.resize(size);
  y_m_.resize(size);
  // Block b has the points b, b + blocks, b + 2 blocks ..., so that a few blocks already estimate a
  // rotation's score. The order does not matter for a sum of integers.
  const std::size_t blocks = (size + kBlock - 1) / kBlock;
  std::size_t to = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t from = block; from < size; from += blocks, ++to) {
      x_m_[to] = points.x_m[from];
      y_m_[to] = points.y_m[from];
    }
  }
}

void LatticeScorer::CopyMap(const ProbabilityView& view) {
  const GridGeometry& map = view.geometry;
  const auto row_size = static_cast<std::size_t>(row_of_map_);
  const int rows = copied_.height_cells + 2;  // a pair of rows may begin in the last one
  row_pairs_.resize(row_size * static_cast<std::size_t>(rows));
  const std::uint32_t unknown = QuantisedProb(view.unknown_prob);
  largest_ = unknown;
  // Columns of the rectangle that the map has.
  const int from_x = std::clamp(map.min_cell.x - copied_.min_cell.x, 0, copied_.width_cells);
  const int to_x = std::clamp(map.min_cell.x + map.width_cells - copied_.min_cell.x, from_x,
                              copied_.width_cells);
  for (int y = 0; y < rows; ++y) {
    std::uint32_t* row = row_pairs_.data() + row_size * static_cast<std::size_t>(y);
    const Cell first{copied_.min_cell.x + from_x, copied_.min_cell.y + y};
    if (to_x > from_x && map.Contains(first)) {
      std::fill(row, row + from_x, unknown);
      largest_ = std::max(largest_, QuantiseRow(view.occupied_prob + map.Index(first),
                                                to_x - from_x, view.unknown_prob, row + from_x));
      std::fill(row + to_x, row + row_size, unknown);
    } else {
      std::fill(row, row + row_size, unknown);
    }
    if (y > 0) PairRows(row, row_size, row - row_size);
  }
}

void LatticeScorer::FindCells(const PointCells& rotation, int first, int count) {
  const int half = lattice_.half_cells;
  // The corner of the point's square, relative to the copied rectangle. Points farther outside
  // reach only unknown cells at every translation.
  const float x_shift = static_cast<float>(rotation.whole_cells.x - copied_.min_cell.x - half);
  const float y_shift = static_cast<float>(rotation.whole_cells.y - copied_.min_cell.y - half);
  const float x_last = static_cast<float>(copied_.width_cells - 2 * half - 1);
  const float y_last = static_cast<float>(copied_.height_cells - 2 * half - 1);
  const float* x_m = x_m_.data() + first;
  const float* y_m = y_m_.data() + first;
  int* cells = cell_of_point_.data();
  const int row = row_of_map_;
  for (int i = 0; i < count; ++i) {
    float x = rotation.X(x_m[i], y_m[i]) + x_shift;
    float y = rotation.Y(x_m[i], y_m[i]) + y_shift;
    x = x < 0.0F ? 0.0F : x;
    y = y < 0.0F ? 0.0F : y;
    x = x > x_last ? x_last : x;
    y = y > y_last ? y_last : y;
    cells[i] = static_cast<int>(y) * row + static_cast<int>(x);
  }
}

void LatticeScorer::AddBlock(int count) {
  const int side = 2 * lattice_.half_cells + 1;
  const int pairs = (side + 1) / 2;
  for (int column = 0; column < side; column += kColumns) {
    for (int pair = 0; pair < pairs; pair += kMaxPairs) {
      const int now = std::min(kMaxPairs, pairs - pair);
      const std::size_t map_offset = static_cast<std::size_t>(2 * pair * row_of_map_ + column);
      const std::size_t sum_offset =
          static_cast<std::size_t>(2 * pair) * row_of_sums_ + static_cast<std::size_t>(column);
      kAddSquares[now](row_pairs_.data() + map_offset, row_of_map_, cell_of_point_.data(), count,
                       sums_.data() + sum_offset, row_of_sums_);
    }
  }
}

bool LatticeScorer::ScoreRotation(int yaw_steps, std::int64_t to_beat) {
  const PointCells rotation = lattice_.CellsAt(yaw_steps);
  std::fill(sums_.begin(), sums_.end(), 0U);
  for (int first = 0; first < points_; first += kBlock) {
    const int count = std::min(kBlock, points_ - first);
    FindCells(rotation, first, count);
    AddBlock(count);
    const int left = points_ - first - count;
    std::uint32_t best = 0;
    for (const std::uint32_t sum : sums_) best = std::max(best, sum);
    if (static_cast<std::int64_t>(best) + static_cast<std::int64_t>(left) * largest_ <= to_beat) {
      return false;
    }
  }
  return true;
}

}  // namespace depthgrid
