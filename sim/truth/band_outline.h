// The surfaces in the obstacle band seen from above. Internal to sim.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/occupancy_map.h"
#include "sim/depth/view_pyramid.h"
#include "sim/mesh/triangle_mesh.h"
#include "sim/truth/band_polygon.h"

namespace depthgrid {

// The z at which to cast rays at the fences below, whatever the band.
constexpr float kFenceMiddleM = 0.5F;

// The band's surfaces for rays in 2D.
struct BandOutline {
  TriangleMesh fences;              // their outlines from above, extruded from z = 0 to 1
  std::vector<ValueSpan> height_m;  // of the surfaces in each cell of the truth map
};

// Heights are computed for the cells of `truth`; the fences do not depend on it.
BandOutline OutlineOf(const TriangleMesh& mesh, const HeightBand& band, const StateMap& truth);

// The index of the occupied cell that contains the hit of a ray. A hit on a cell boundary may be
// rounded to either side; the occupied cell of the two is returned.
std::optional<std::size_t> OccupiedCellAt(const StateMap& truth, const Eigen::Vector2d& hit);

}  // namespace depthgrid
