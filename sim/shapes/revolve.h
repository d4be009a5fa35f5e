// Solids of revolution: cylinders, cones, spheres, tori and anything else a lathe can turn.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// Points (r, z), r >= 0, of a closed polygon in the half-plane beside the z axis. Its orientation
// does not matter; edges on the axis make no surface.
using LatheOutline = std::vector<Eigen::Vector2d>;

// Turns the outline about z. `segments` (at least 3) flat facets replace a full circle; their
// corners lie on it, so the solid is inscribed.
TriangleMesh Revolve(const LatheOutline& outline, int segments);

// The bottom's centre is the origin; a top radius of 0 gives a cone's tip.
LatheOutline FrustumOutline(double bottom_radius_m, double top_radius_m, double height_m);
// The centre is the origin; half as many facets from pole to pole as around.
LatheOutline SphereOutline(double radius_m, int segments);
// The centre is the origin; the tube's centre line is a circle of radius `ring_radius_m`.
LatheOutline TorusOutline(double ring_radius_m, double tube_radius_m, int segments);

}  // namespace depthgrid
