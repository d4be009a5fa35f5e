// Swept shapes: tubes along a path, prisms, curtains, leaves.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/mesh/polygon.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// The simple outline (any orientation), from z = 0 to z = height_m.
TriangleMesh MakePrism(const Polygon& outline, double height_m);

// A round tube along a path of at least two points (three when closed), with flat caps and a radius
// that changes linearly from start to end. The path is first smoothed by `smooth` rounds of corner
// cutting.
struct TubeShape {
  std::vector<Eigen::Vector3d> path;
  double start_radius_m = 0.01;
  double end_radius_m = 0.01;
  bool closed = false;
  int smooth = 0;
  int segments = 12;
};
TriangleMesh MakeTube(const TubeShape& tube);

// A curtain with folds along x, its lower edge at z = 0, centred on the origin.
struct CurtainShape {
  double width_m = 1.0;
  double height_m = 2.0;
  double depth_m = 0.08;  // crest to trough
  double thickness_m = 0.004;
  int folds = 8;
  int segments = 16;  // facets per fold
};
TriangleMesh MakeCurtain(const CurtainShape& curtain);

// A blade from the origin along +x, bending down by `bend_deg` from base to tip; its cross-section
// is a flat rhombus, so it is closed.
struct LeafShape {
  double length_m = 0.3;
  double width_m = 0.06;
  double thickness_m = 0.003;
  double bend_deg = 60.0;
  int segments = 12;
};
TriangleMesh MakeLeaf(const LeafShape& leaf);

}  // namespace depthgrid
