// The fast half of the correlative search: the scores of all translations of one rotation at once.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/match/search_lattice.h"

namespace depthgrid {

// Scores are those of LatticeScore, bit for bit. One point adds a square of the map, one cell a
// translation; with the map as 16-bit numbers whose rows y and y + 1 lie interleaved, one 32-byte
// load is 8 translations in x by 2 in y. Keeps its memory from search to search.
class LatticeScorer {
 public:
  // Borrows nothing: points and the part of the map they can reach are copied.
  void Prepare(const SearchLattice& lattice, const MatchPoints& points,
               const ProbabilityView& view);

  // Scores one rotation. False, with scores left undefined, as soon as no translation can reach
  // more than `to_beat` any more.
  bool ScoreRotation(int yaw_steps, std::int64_t to_beat);

  // Of the last rotation scored; x and y in -half_cells..half_cells.
  std::uint32_t Score(int x_cells, int y_cells) const {
    return sums_[ScoreIndex(x_cells, y_cells)];
  }

 private:
  std::size_t ScoreIndex(int x_cells, int y_cells) const {
    return static_cast<std::size_t>(y_cells + lattice_.half_cells) * row_of_sums_ +
           static_cast<std::size_t>(x_cells + lattice_.half_cells);
  }
  void CopyPoints(const MatchPoints& points);
  void CopyMap(const ProbabilityView& view);
  void FindCells(const PointCells& rotation, int first, int count);
  void AddBlock(int count);

  SearchLattice lattice_;
  std::vector<float> x_m_;  // in an order that spreads every block over the whole scan
  std::vector<float> y_m_;
  int points_ = 0;

  GridGeometry copied_;
  int row_of_map_ = 0;  // rows are padded so that loads past a row's end stay inside
  std::vector<std::uint32_t>
      row_pairs_;  // cell (x, y) in the low half, (x, y + 1) in the high half
  std::uint32_t largest_ = 0;

  std::vector<int> cell_of_point_;  // of one block: index of the corner of the point's square
  std::size_t row_of_sums_ = 0;
  std::vector<std::uint32_t> sums_;
};

}  // namespace depthgrid
