#include "mapper/scan/trodden_cells.h"

#include <cmath>

namespace depthgrid {

std::size_t TroddenCells::CellAt(const Eigen::Vector2d& place_m) {
  const auto wrapped = [](double along_m) {
    const double cell = std::floor(along_m / kCellM);
    return static_cast<std::size_t>(cell - kCells * std::floor(cell / kCells));
  };
  return wrapped(place_m.y()) * kCells + wrapped(place_m.x());
}

}  // namespace depthgrid
