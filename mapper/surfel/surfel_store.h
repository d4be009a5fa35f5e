// Surfels of everything seen, found by place.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "mapper/core/grid_geometry.h"

namespace depthgrid {

// A short piece of wall: a point that moves only along its normal, which points to the free side.
struct Surfel {
  Eigen::Vector2d point_m;
  Eigen::Vector2d normal;
  double information = 0.0;         // of the point along the normal, 1/m^2
  double normal_information = 0.0;  // of the normal's angle, 1/rad^2
  int next = -1;                    // the next surfel of the same cell
  int first_frame = 0;
  int last_frame = 0;
};

class SurfelStore {
 public:
  explicit SurfelStore(double cell_m = 0.1) : cell_m_(cell_m) {}

  const std::vector<Surfel>& surfels() const { return surfels_; }
  Surfel& at(int index) { return surfels_[static_cast<std::size_t>(index)]; }
  const Surfel& at(int index) const { return surfels_[static_cast<std::size_t>(index)]; }
  int Add(const Surfel& surfel);
  void Clear();

  // Calls visit(index) for every surfel in the cells that overlap the box.
  template <typename Visit>
  void ForEachIn(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, Visit visit) const {
    const Cell low = CellOf(low_m, cell_m_);
    const Cell high = CellOf(high_m, cell_m_);
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        for (int i = Head({x, y}); i >= 0; i = at(i).next) visit(i);
      }
    }
  }

 private:
  static constexpr int kTileBits = 5;  // tiles of 32 x 32 cells
  static constexpr int kTileMask = (1 << kTileBits) - 1;
  using Tile = std::array<int, 1U << (2 * kTileBits)>;

  static std::uint64_t Key(const Cell& cell) {
    const auto x = static_cast<std::uint32_t>(cell.x >> kTileBits);
    const auto y = static_cast<std::uint32_t>(cell.y >> kTileBits);
    return (std::uint64_t{y} << 32) | x;
  }
  static std::size_t Place(const Cell& cell) {
    return static_cast<std::size_t>(((cell.y & kTileMask) << kTileBits) | (cell.x & kTileMask));
  }
  int Head(const Cell& cell) const {
    const std::uint64_t key = Key(cell);
    if (key != last_key_ || last_tile_ == nullptr) {
      const auto found = tiles_.find(key);
      if (found == tiles_.end()) return -1;
      last_key_ = key;
      last_tile_ = found->second.get();
    }
    return (*last_tile_)[Place(cell)];
  }

  double cell_m_;
  std::vector<Surfel> surfels_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Tile>> tiles_;
  mutable std::uint64_t last_key_ = 0;
  mutable const Tile* last_tile_ = nullptr;
};

}  // namespace depthgrid
