// Solids of revolution: cylinders, cones, spheres, tori and others.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// Points (r, z), r >= 0, of a closed polygon in the half-plane beside the z axis. Its orientation
// does not matter; edges on the axis give no surface.
using LatheOutline = std::vector<Eigen::Vector2d>;

// Revolves the outline about z. A full circle becomes `segments` (at least 3) flat facets with
// corners on the circle, so the mesh is inscribed.
TriangleMesh Revolve(const LatheOutline& outline, int segments);

// The origin is the bottom's centre; a top radius of 0 gives a cone.
LatheOutline FrustumOutline(double bottom_radius_m, double top_radius_m, double height_m);
// The centre is the origin; half as many facets from pole to pole as around.
LatheOutline SphereOutline(double radius_m, int segments);
// The centre is the origin; the tube's centre line is a circle of radius `ring_radius_m`.
LatheOutline TorusOutline(double ring_radius_m, double tube_radius_m, int segments);

}  // namespace depthgrid
