// A set of cells, such as the observable ones or those in one state.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/grid_geometry.h"

namespace depthgrid {

struct CellSet {
  GridGeometry geometry;
  std::vector<std::uint8_t> members;  // geometry.size(); 1 for a member, else 0

  CellSet() = default;
  explicit CellSet(const GridGeometry& g) : geometry(g), members(g.size(), 0) {}
  // False outside the rectangle.
  bool Has(const Cell& cell) const {
    return geometry.Contains(cell) && members[geometry.Index(cell)] != 0;
  }
  bool operator==(const CellSet&) const = default;
};

}  // namespace depthgrid
