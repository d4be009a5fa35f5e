#include "mapper/match/distance_field.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {

DistanceField::DistanceField(const OccupancyMap& map, double farthest_m)
    : geometry_(map.geometry),
      farthest_m_(farthest_m),
      distance_m_(map.geometry.size(), static_cast<float>(farthest_m)) {
  states_ = StatesOf(map).states;
  for (std::size_t i = 0; i < distance_m_.size(); ++i) {
    if (states_[i] != CellState::kOccupied) continue;
    distance_m_[i] = 0.0F;
    any_ = true;
  }
  Sweep(1);
  Sweep(-1);
}

void DistanceField::Sweep(int way) {
  const auto near = static_cast<float>(geometry_.resolution_m);
  const float diagonal = near * std::sqrt(2.0F);
  const int width = geometry_.width_cells;
  const int height = geometry_.height_cells;
  const auto at = [&](int x, int y) -> float& {
    return distance_m_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(x)];
  };
  for (int row = 0; row < height; ++row) {
    const int y = way > 0 ? row : height - 1 - row;
    for (int column = 0; column < width; ++column) {
      const int x = way > 0 ? column : width - 1 - column;
      float& here = at(x, y);
      const auto from = [&](int dx, int dy, float step) {
        const int nx = x - way * dx;
        const int ny = y - way * dy;
        if (nx < 0 || ny < 0 || nx >= width || ny >= height) return;
        here = std::min(here, at(nx, ny) + step);
      };
      from(1, 0, near);
      from(0, 1, near);
      from(1, 1, diagonal);
      from(-1, 1, diagonal);
    }
  }
}

}  // namespace depthgrid
