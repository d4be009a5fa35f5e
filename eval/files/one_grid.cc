#include "eval/files/one_grid.h"

#include <fmt/format.h>

#include "mapper/core/error.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {
namespace {

bool IsUsable(const GridGeometry& both, std::size_t cells_of_maps) {
  constexpr std::size_t kSoon = std::size_t{1} << 24;  // sizes up to this take only seconds
  constexpr std::size_t kMostSpread = 16;
  return both.size() <= kSoon ||
         (both.size() <= kMaxMapCells && both.size() <= kMostSpread * cells_of_maps);
}

}  // namespace

GridGeometry OneGridAround(const GridGeometry& known, const std::string& known_path,
                           const GridGeometry& other, const std::string& other_path) {
  const GridGeometry both = Union(known, other);
  if (IsUsable(both, known.size() + other.size())) return both;
  const Eigen::Vector2d from = known.OriginM(), to = other.OriginM();
  throw InputError(
      other_path, fmt::format("its lower left corner ({:g}, {:g}) lies {:.0f} m from ({:g}, {:g}), "
                              "that of {}: one grid around both would have {} x {} cells",
                              to.x(), to.y(), (to - from).norm(), from.x(), from.y(), known_path,
                              both.width_cells, both.height_cells));
}

}  // namespace depthgrid
