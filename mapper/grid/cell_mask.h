// A set of cells as bits, 64 cells of a row in a word. Words start at multiples of 64 cells, so
// masks and tiles (mapper/grid/map_drawing.h) of one resolution line up.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "mapper/core/grid_geometry.h"

namespace depthgrid {

constexpr int kWordCells = 64;

// The word column of a cell column: floor division.
inline int WordOf(int cell_x) { return cell_x >> 6; }

class CellMask {
 public:
  CellMask() = default;

  // Makes the mask empty and large enough for the cells from `min` to `max`, both included. Keeps
  // its memory.
  void Reset(const Cell& min, const Cell& max) {
    first_word_ = WordOf(min.x);
    first_row_ = min.y;
    words_per_row_ = WordOf(max.x) - first_word_ + 1;
    rows_ = max.y - min.y + 1;
    bits_.assign(static_cast<std::size_t>(words_per_row_) * static_cast<std::size_t>(rows_), 0);
  }

  int first_word() const { return first_word_; }
  int first_row() const { return first_row_; }
  int words_per_row() const { return words_per_row_; }
  int rows() const { return rows_; }
  // Cells of the rectangle, in the set or not.
  std::size_t size() const { return bits_.size() * static_cast<std::size_t>(kWordCells); }

  // Words of row `y`, words_per_row() of them.
  std::uint64_t* Row(int y) { return bits_.data() + RowOffset(y); }
  const std::uint64_t* Row(int y) const { return bits_.data() + RowOffset(y); }

  void Set(const Cell& cell) {
    Row(cell.y)[WordOf(cell.x) - first_word_] |= std::uint64_t{1} << (cell.x & (kWordCells - 1));
  }
  // Sets the cells first_x to last_x of a row, both included.
  void SetSpan(int y, int first_x, int last_x) {
    std::uint64_t* row = Row(y) - first_word_;
    const int first_word = WordOf(first_x);
    const int last_word = WordOf(last_x);
    const std::uint64_t from_first = ~std::uint64_t{0} << (first_x & (kWordCells - 1));
    const std::uint64_t to_last =
        ~std::uint64_t{0} >> (kWordCells - 1 - (last_x & (kWordCells - 1)));
    if (first_word == last_word) {
      row[first_word] |= from_first & to_last;
      return;
    }
    row[first_word] |= from_first;
    for (int word = first_word + 1; word < last_word; ++word) row[word] = ~std::uint64_t{0};
    row[last_word] |= to_last;
  }
  // Takes out the cells of a mask of the same rectangle.
  void Remove(const CellMask& other) {
    for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] &= ~other.bits_[i];
  }
  // False outside the mask's rectangle.
  bool Contains(const Cell& cell) const {
    const int word = WordOf(cell.x) - first_word_;
    if (cell.y < first_row_ || cell.y >= first_row_ + rows_ || word < 0 || word >= words_per_row_) {
      return false;
    }
    return ((Row(cell.y)[word] >> (cell.x & (kWordCells - 1))) & 1U) != 0;
  }
  bool operator==(const CellMask&) const = default;

  std::size_t Count() const {
    std::size_t count = 0;
    for (const std::uint64_t word : bits_) count += static_cast<std::size_t>(std::popcount(word));
    return count;
  }

 private:
  std::size_t RowOffset(int y) const {
    return static_cast<std::size_t>(y - first_row_) * static_cast<std::size_t>(words_per_row_);
  }

  int first_word_ = 0;
  int first_row_ = 0;
  int words_per_row_ = 0;
  int rows_ = 0;
  std::vector<std::uint64_t> bits_;
};

}  // namespace depthgrid
