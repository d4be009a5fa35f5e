#include "mapper/match/lattice_scorer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace depthgrid {
namespace {

// 64 quantised probabilities sum up to less than 2^16.
constexpr int kBlock = 64;
static_assert(kBlock * kMatchProbScale < (1 << 16));

constexpr int kColumns = 8;   // translations in x a load covers
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

}  // namespace

void LatticeScorer::Prepare(const SearchLattice& lattice, const MatchPoints& points,
                            const ProbabilityView& view) {
  lattice_ = lattice;
  CopyPoints(points);
  CopyMap(points, view);
  const int side = 2 * lattice.half_cells + 1;
  row_of_sums_ = static_cast<std::size_t>(RoundUp(side, kColumns));
  sums_.resize(row_of_sums_ * static_cast<std::size_t>(side + 1));
  cell_of_point_.resize(kBlock);
}

void LatticeScorer::CopyPoints(const MatchPoints& points) {
  points_ = points.size();
  const auto size = static_cast<std::size_t>(points_);
  x_m_.resize(size);
  y_m_.resize(size);
  // Block b takes points b, b + blocks, b + 2 blocks ...: a few blocks already know how good a
  // rotation is. The order of a sum of integers does not matter.
  const std::size_t blocks = (size + kBlock - 1) / kBlock;
  std::size_t to = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t from = block; from < size; from += blocks, ++to) {
      x_m_[to] = points.x_m[from];
      y_m_[to] = points.y_m[from];
    }
  }
}

void LatticeScorer::CopyMap(const MatchPoints& points, const ProbabilityView& view) {
  // Where points can come to lie: their box at the predicted yaw, wider by what a rotation within
  // the window moves the farthest of them (a chord is shorter than its arc), plus rounding.
  const LatticeRotation middle(lattice_, 0);
  const auto cells_of = [&](const std::vector<float>& along_x, const std::vector<float>& along_y,
                            auto cell_of) {
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
    for (std::size_t i = 0; i < along_x.size(); ++i) {
      const float cell = cell_of(along_x[i], along_y[i]);
      low = std::min(low, cell);
      high = std::max(high, cell);
    }
    return std::pair<float, float>(low, high);
  };
  const auto [x_low, x_high] =
      cells_of(points.x_m, points.y_m, [&](float x, float y) { return middle.XCells(x, y); });
  const auto [y_low, y_high] =
      cells_of(points.x_m, points.y_m, [&](float x, float y) { return middle.YCells(x, y); });
  const double turn_rad = std::min(2.0, lattice_.half_yaw_steps * lattice_.yaw_step_rad);
  const double turn_cells = turn_rad * points.farthest_m / lattice_.resolution_m + 2.0;

  // Nothing beyond the map plus one square needs to be told apart: it is all unknown.
  const int half = lattice_.half_cells;
  const GridGeometry& map = view.geometry;
  const auto clip = [&](double low, double high, int whole, int map_first, int map_cells) {
    const double map_low = map_first - 2.0 * half - 1.0;
    const double map_high = map_first + map_cells + 2.0 * half;
    const double first = std::clamp(low - turn_cells - half + whole, map_low, map_high);
    const double last = std::clamp(high + turn_cells + half + whole, map_low, map_high);
    return std::pair<int, int>(static_cast<int>(std::floor(first)),
                               static_cast<int>(std::ceil(last)));
  };
  const auto [x_first, x_last] =
      clip(x_low, x_high, middle.whole_cells.x, map.min_cell.x, map.width_cells);
  const auto [y_first, y_last] =
      clip(y_low, y_high, middle.whole_cells.y, map.min_cell.y, map.height_cells);
  first_cell_ = {x_first, y_first};
  width_cells_ = std::max(x_last - x_first + 1, 2 * half + 1);
  height_cells_ = std::max(y_last - y_first + 1, 2 * half + 1);
  row_of_map_ = RoundUp(width_cells_ + kColumns, kColumns);

  const auto row_size = static_cast<std::size_t>(row_of_map_);
  const std::uint32_t unknown = QuantisedProb(view.unknown_prob);
  row_pairs_.resize(row_size * static_cast<std::size_t>(height_cells_ + 2));
  row_.resize(row_size);
  // Columns of the rectangle that the map has.
  const int from_x = std::clamp(map.min_cell.x - x_first, 0, width_cells_);
  const int to_x = std::clamp(map.min_cell.x + map.width_cells - x_first, from_x, width_cells_);
  std::fill(row_.begin(), row_.end(), unknown);
  largest_ = unknown;
  for (int y = 0; y < height_cells_ + 2; ++y) {
    const int map_y = first_cell_.y + y;
    const bool inside = map_y >= map.min_cell.y && map_y < map.min_cell.y + map.height_cells;
    if (inside && to_x > from_x) {
      const float* source = view.occupied_prob + map.Index({x_first + from_x, map_y});
      std::uint32_t* target = row_.data() + from_x;
      std::uint32_t largest = largest_;
      for (int x = 0; x < to_x - from_x; ++x) {
        const float prob = source[x] == source[x] ? source[x] : view.unknown_prob;
        const auto value = static_cast<std::uint32_t>(
            static_cast<int>(prob * static_cast<float>(kMatchProbScale) + 0.5F));
        target[x] = value;
        largest = std::max(largest, value);
      }
      largest_ = largest;
    } else {
      std::fill(row_.begin(), row_.end(), unknown);
    }
    std::uint32_t* here = row_pairs_.data() + row_size * static_cast<std::size_t>(y);
    std::uint32_t* below = y > 0 ? here - row_size : nullptr;
    for (std::size_t x = 0; x < row_size; ++x) here[x] = row_[x];
    if (below != nullptr) {
      for (std::size_t x = 0; x < row_size; ++x) below[x] |= row_[x] << 16;
    }
  }
}

void LatticeScorer::FindCells(const LatticeRotation& rotation, int first, int count) {
  const int half = lattice_.half_cells;
  // The square's corner, relative to the copied rectangle. Points farther outside than the
  // rectangle reaches see nothing but unknown cells, wherever they are moved to.
  const float x_shift = static_cast<float>(rotation.whole_cells.x - first_cell_.x - half);
  const float y_shift = static_cast<float>(rotation.whole_cells.y - first_cell_.y - half);
  const float x_last = static_cast<float>(width_cells_ - 2 * half - 1);
  const float y_last = static_cast<float>(height_cells_ - 2 * half - 1);
  const float* x_m = x_m_.data() + first;
  const float* y_m = y_m_.data() + first;
  int* cells = cell_of_point_.data();
  const int row = row_of_map_;
  for (int i = 0; i < count; ++i) {
    float x = rotation.XCells(x_m[i], y_m[i]) + x_shift;
    float y = rotation.YCells(x_m[i], y_m[i]) + y_shift;
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
  const LatticeRotation rotation(lattice_, yaw_steps);
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
