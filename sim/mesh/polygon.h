// Plane polygons: outlines of prisms and solids of revolution.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace depthgrid {

using Polygon = std::vector<Eigen::Vector2d>;  // corners in order; the last joins the first

// Positive for counter-clockwise corners.
double SignedArea(const Polygon& polygon);

// True when no two edges touch except neighbours at their common corner, and the area is not zero.
bool IsSimple(const Polygon& polygon);

// Triangles (corner indices, counter-clockwise) of a simple counter-clockwise polygon, by ear
// clipping: typically quadratic, meant for up to a few hundred corners.
std::vector<std::array<std::uint32_t, 3>> Triangulate(const Polygon& polygon);

}  // namespace depthgrid
