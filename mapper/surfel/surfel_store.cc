#include "mapper/surfel/surfel_store.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// A frame this much later than those that drew a surfel was placed by a match against it and shares
// its error, so the surfel's mean frame stays that of the first visit (docs/tried.md,
// "Consistency").
constexpr float kVisitFrames = 400.0F;
// Margin of the search beyond the gate: a surfel that moved stays in the cell it was added to.
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

// Lower bound, in units of the gate, on the distance of surfels outside the searched box: up to
// this size the gate's ellipse, turned by the greatest angle between normals, fits in the box.
double LeastOutside(const AssociationGate& gate) {
  const double cosine = std::clamp(gate.min_cosine - SurfelStore::kFirmRad, 0.0, 1.0);
  const double sine2 = 1.0 - cosine * cosine;
  const double small = std::min(gate.along_m, gate.off_m);
  const double large = std::max(gate.along_m, gate.off_m);
  const double extent2 = small * small + sine2 * (large * large - small * small);
  return small / std::sqrt(extent2);
}

}  // namespace

SurfelStore::Found SurfelStore::Search(const Surfel& piece, const AssociationGate& gate) const {
  // Bounding box of the gate's rectangle, aligned with the piece.
  const Eigen::Vector2d across = piece.normal.cwiseAbs();
  const Eigen::Vector2d along(across.y(), across.x());
  const Eigen::Vector2d half_m =
      across * gate.off_m + along * gate.along_m + Eigen::Vector2d::Constant(kMovedM);
  const Cell low = CellOf(piece.point_m - half_m, kCellM);
  const Cell high = CellOf(piece.point_m + half_m, kCellM);
  const double per_along = 1.0 / gate.along_m;
  const double per_off = 1.0 / gate.off_m;
  const double narrowly = gate.min_cosine - kFirmRad;
  Found found;
  const auto consider = [&](int i) {
    const Surfel& surfel = surfels_[static_cast<std::size_t>(i)];
    const double cosine = surfel.normal.dot(piece.normal);
    if (cosine < narrowly) return;
    const Eigen::Vector2d d_m = piece.point_m - surfel.point_m;
    const double a = (d_m.x() * surfel.normal.y() - d_m.y() * surfel.normal.x()) * per_along;
    const double o = d_m.dot(surfel.normal) * per_off;
    const double distance2 = a * a + o * o;
    // Ties go to the surfel added first, regardless of its cell.
    const bool is_nearest =
        distance2 < found.distance2 || (distance2 == found.distance2 && i < found.index);
    if (is_nearest && std::abs(a) <= 1.0 && std::abs(o) <= 1.0 && cosine >= gate.min_cosine) {
      found.next_distance2 = std::min(found.next_distance2, found.distance2);
      found.distance2 = distance2;
      found.index = i;
    } else {
      found.next_distance2 = std::min(found.next_distance2, distance2);
    }
  };
  // Tile by tile, row by row within each.
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
  return found;
}

Association SurfelStore::NearestFirmly(const Surfel& piece, const AssociationGate& gate) const {
  const Found found = Search(piece, gate);
  if (found.index < 0) return {};
  const Surfel& surfel = surfels_[static_cast<std::size_t>(found.index)];
  if (surfel.normal.dot(piece.normal) < gate.min_cosine + kFirmRad) return {found.index, 0.0};
  const double distance = std::sqrt(found.distance2);
  const double next = std::min(std::sqrt(found.next_distance2), LeastOutside(gate));
  const double off = std::abs(OffsetFrom(surfel, piece.point_m)) / gate.off_m;
  const double along = std::sqrt(std::max(0.0, found.distance2 - off * off));
  // A shift by s changes each scaled distance by at most s / min(along_m, off_m), the two possibly
  // in opposite directions.
  const double slack = std::min(0.5 * (next - distance), 1.0 - std::max(off, along));
  return {found.index, std::max(0.0, slack) * std::min(gate.along_m, gate.off_m)};
}

int SurfelStore::Merge(const Surfel& piece, const AssociationGate& gate, double frame) {
  newest_frame_ = std::max(newest_frame_, frame);
  const int index = Nearest(piece, gate);
  if (index < 0) return Add(piece, frame);
  Surfel& surfel = surfels_[static_cast<std::size_t>(index)];
  Fuse(piece, surfel);
  float& mean = frames_[static_cast<std::size_t>(index)];
  const float later = static_cast<float>(frame) - mean;
  const auto share = static_cast<float>(piece.information / surfel.information);
  if (later < kVisitFrames) mean += share * later;
  return index;
}

int SurfelStore::Add(const Surfel& surfel, double frame) {
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
  frames_.push_back(static_cast<float>(frame));
  next_in_cell_.push_back(first);
  first = index;
  return index;
}

void SurfelStore::Clear() {
  surfels_.clear();
  frames_.clear();
  newest_frame_ = 0.0;
  next_in_cell_.clear();
  tile_of_key_.Clear();
  tiles_.clear();
}

}  // namespace depthgrid
