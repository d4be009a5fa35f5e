// The obstacle band's surfaces seen from above. Only for sim's own .cc files.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/occupancy_map.h"
#include "sim/depth/view_pyramid.h"
#include "sim/mesh/triangle_mesh.h"
#include "sim/truth/band_polygon.h"

namespace depthgrid {

// The height at which rays meet the fences below, whatever the band.
constexpr float kFenceMiddleM = 0.5F;

// The band's surfaces for rays that do not care about height.
struct BandOutline {
  TriangleMesh fences;              // what they look like from above, drawn out from z = 0 to 1
  std::vector<ValueSpan> height_m;  // of the surfaces in each cell of the truth map
};

// `truth` says which cells heights are wanted of; lines are the same whatever it covers.
BandOutline OutlineOf(const TriangleMesh& mesh, const HeightBand& band, const StateMap& truth);

// The cell of the surface that a ray met there, by its index. A hit on a cell boundary lands on
// either side of it by rounding; the occupied one of the two is meant.
std::optional<std::size_t> OccupiedCellAt(const StateMap& truth, const Eigen::Vector2d& hit);

}  // namespace depthgrid
