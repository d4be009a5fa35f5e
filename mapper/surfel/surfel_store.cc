#include "mapper/surfel/surfel_store.h"

namespace depthgrid {

int SurfelStore::Add(const Surfel& surfel) {
  const Cell cell = CellOf(surfel.point_m, cell_m_);
  std::unique_ptr<Tile>& tile = tiles_[Key(cell)];
  if (!tile) {
    tile = std::make_unique<Tile>();
    tile->fill(-1);
  }
  int& head = (*tile)[Place(cell)];
  const int index = static_cast<int>(surfels_.size());
  surfels_.push_back(surfel);
  surfels_.back().next = head;
  head = index;
  return index;
}

void SurfelStore::Clear() {
  surfels_.clear();
  tiles_.clear();
  last_tile_ = nullptr;
}

}  // namespace depthgrid
