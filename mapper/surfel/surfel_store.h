// Surfels with a spatial index. Memory grows with the area seen; look-ups take constant time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mapper/core/grid_geometry.h"
#include "mapper/core/key_index.h"
#include "mapper/surfel/surfel.h"

namespace depthgrid {

// Limits within which a piece and a surfel are associated.
struct AssociationGate {
  double along_m = 0.0;     // between their points, along the surfel
  double off_m = 0.0;       // along its normal
  double min_cosine = 0.0;  // between the normals
};

// Ratio of AssociationGate::along_m to the wanted spacing of surfels along a wall: they end up 0.6
// to 1.2 spacings apart.
constexpr double kAlongShare = 0.6;

// The surfel a piece is associated with, and how far that remains valid.
struct Association {
  int index = -1;
  // The association cannot change while the piece moves by less than this and turns by less than
  // SurfelStore::kFirmRad.
  double firm_m = 0.0;
};

class SurfelStore {
 public:
  static constexpr double kFirmRad = 0.01;

  int size() const { return static_cast<int>(surfels_.size()); }
  const Surfel& operator[](int index) const { return surfels_[static_cast<std::size_t>(index)]; }
  const std::vector<Surfel>& surfels() const { return surfels_; }

  // The surfel the piece belongs to, -1 if none: the nearest one, distances counted in gates.
  int Nearest(const Surfel& piece, const AssociationGate& gate) const {
    return Search(piece, gate).index;
  }
  Association NearestFirmly(const Surfel& piece, const AssociationGate& gate) const;
  // Fuses the piece into its nearest surfel, which moves along its normal and turns, or adds it as
  // a new surfel. Returns the index. `frame`: the observing frame, or a mean of several.
  int Merge(const Surfel& piece, const AssociationGate& gate, double frame = 0.0);
  int Add(const Surfel& surfel, double frame = 0.0);
  // Information-weighted mean of the frames that drew a surfel; only those of the first visit, if
  // it was seen again long after.
  double FrameOf(int index) const {
    return static_cast<double>(frames_[static_cast<std::size_t>(index)]);
  }
  // The newest frame that saw a surfel.
  double newest_frame() const { return newest_frame_; }
  void Clear();

 private:
  // Distances in units of the gate.
  struct Found {
    int index = -1;
    double distance2 = 2.0;
    double next_distance2 = 2.0;  // of all others, also just outside the gate
  };
  Found Search(const Surfel& piece, const AssociationGate& gate) const;

  static constexpr double kCellM = 0.1;
  static constexpr int kTileBits = 5;  // tiles of 32 x 32 cells
  static constexpr int kTileMask = (1 << kTileBits) - 1;
  // The first surfel of each cell, -1 if none.
  using Tile = std::array<int, 1U << (2 * kTileBits)>;

  static std::uint64_t KeyOf(const Cell& cell) {
    return (std::uint64_t{static_cast<std::uint32_t>(cell.y >> kTileBits)} << 32) |
           static_cast<std::uint32_t>(cell.x >> kTileBits);
  }
  static std::size_t PlaceOf(const Cell& cell) {
    return static_cast<std::size_t>(((cell.y & kTileMask) << kTileBits) | (cell.x & kTileMask));
  }
  const Tile* TileOf(const Cell& cell) const {
    const int tile = tile_of_key_.Find(KeyOf(cell));
    return tile < 0 ? nullptr : &tiles_[static_cast<std::size_t>(tile)];
  }

  std::vector<Surfel> surfels_;
  double newest_frame_ = 0.0;
  std::vector<float> frames_;      // parallel to surfels_
  std::vector<int> next_in_cell_;  // parallel to surfels_
  KeyIndex tile_of_key_;
  std::vector<Tile> tiles_;
};

}  // namespace depthgrid
