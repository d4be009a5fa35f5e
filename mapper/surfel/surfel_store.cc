#include "mapper/surfel/surfel_store.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// A surfel that moved stays in the cell it was added to; so much is looked beyond the gate for it.
constexpr double kMovedM = 0.02;

void Fuse(const Surfel& piece, Surfel& surfel) {
  surfel.information += piece.information;
  const double share = piece.information / surfel.information;
  surfel.point_m += share * OffsetFrom(surfel, piece.point_m) * surfel.normal;
  const double sine = surfel.normal.x() * piece.normal.y() - surfel.normal.y() * piece.normal.x();
  const double turn_rad = std::atan2(sine, surfel.normal.dot(piece.normal));
  surfel.normal_information += piece.normal_information;
  const double step_rad = piece.normal_information / surfel.normal_information * turn_rad;
  surfel.normal = Motion2({0.0, 0.0, step_rad}).Turn(surfel.normal).normalized();
}

}  // namespace

int SurfelStore::Nearest(const Surfel& piece, const AssociationGate& gate) const {
  // The gate's rectangle, turned along the piece and put in a box.
  const Eigen::Vector2d across = piece.normal.cwiseAbs();
  const Eigen::Vector2d along(across.y(), across.x());
  const Eigen::Vector2d half_m =
      across * gate.off_m + along * gate.along_m + Eigen::Vector2d::Constant(kMovedM);
  const Cell low = CellOf(piece.point_m - half_m, kCellM);
  const Cell high = CellOf(piece.point_m + half_m, kCellM);
  const double per_along = 1.0 / gate.along_m;
  const double per_off = 1.0 / gate.off_m;
  int nearest = -1;
  double nearest_distance2 = 2.0;
  const auto consider = [&](int i) {
    const Surfel& surfel = surfels_[static_cast<std::size_t>(i)];
    if (surfel.normal.dot(piece.normal) < gate.min_cosine) return;
    const Eigen::Vector2d d_m = piece.point_m - surfel.point_m;
    const double a = (d_m.x() * surfel.normal.y() - d_m.y() * surfel.normal.x()) * per_along;
    const double o = d_m.dot(surfel.normal) * per_off;
    if (std::abs(a) > 1.0 || std::abs(o) > 1.0) return;
    const double distance2 = a * a + o * o;
    // Ties go to the surfel added first, wherever it is in its cell.
    if (distance2 < nearest_distance2 || (distance2 == nearest_distance2 && i < nearest)) {
      nearest_distance2 = distance2;
      nearest = i;
    }
  };
  // Tile by tile, and in each row by row.
  for (int tile_y = low.y; tile_y <= high.y; tile_y = (tile_y | kTileMask) + 1) {
    const int last_y = std::min(high.y, tile_y | kTileMask);
    for (int tile_x = low.x; tile_x <= high.x; tile_x = (tile_x | kTileMask) + 1) {
      const Tile* tile = TileOf({tile_x, tile_y});
      if (tile == nullptr) continue;
      const int cells = std::min(high.x, tile_x | kTileMask) - tile_x + 1;
      for (int y = tile_y; y <= last_y; ++y) {
        const int* first = tile->data() + PlaceOf({tile_x, y});
        for (int cell = 0; cell < cells; ++cell) {
          for (int i = first[cell]; i >= 0; i = next_in_cell_[static_cast<std::size_t>(i)]) {
            consider(i);
          }
        }
      }
    }
  }
  return nearest;
}

int SurfelStore::Merge(const Surfel& piece, const AssociationGate& gate) {
  const int index = Nearest(piece, gate);
  if (index < 0) return Add(piece);
  Fuse(piece, surfels_[static_cast<std::size_t>(index)]);
  return index;
}

int SurfelStore::Add(const Surfel& surfel) {
  const Cell cell = CellOf(surfel.point_m, kCellM);
  int tile = tile_of_key_.Find(KeyOf(cell));
  if (tile < 0) {
    tile = static_cast<int>(tiles_.size());
    tile_of_key_.Add(KeyOf(cell), tile);
    tiles_.emplace_back().fill(-1);
  }
  int& first = tiles_[static_cast<std::size_t>(tile)][PlaceOf(cell)];
  const int index = size();
  surfels_.push_back(surfel);
  next_in_cell_.push_back(first);
  first = index;
  return index;
}

void SurfelStore::Clear() {
  surfels_.clear();
  next_in_cell_.clear();
  tile_of_key_.Clear();
  tiles_.clear();
}

}  // namespace depthgrid
