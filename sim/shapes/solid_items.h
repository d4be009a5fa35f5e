// Boxes, cylinders, cones, spheres, tori and superellipsoids in scene files: keys, defaults and
// meshes. Internal to sim/shapes/shapes.cc.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>

#include "mapper/core/error.h"
#include "sim/shapes/box.h"
#include "sim/shapes/item_options.h"
#include "sim/shapes/revolve.h"
#include "sim/shapes/superellipsoid.h"

namespace depthgrid {

constexpr Interval kRadiusOrTip = {0.0, kMaxSceneExtentM};

inline Eigen::Vector3d AsVector(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

struct BoxItem {
  std::array<double, 3> size = {1, 1, 1};
  double radius_m = 0.0;
  int segments = 4;
  void Visit(OptionsVisitor& v) {
    v.Tuple("size", size, kLength, "length along x, y, z, metres");
    v.Number("radius_m", radius_m, kRadiusOrTip, "of the rounded edges; 0 keeps them sharp");
    v.Number("segments", segments, {1, 64}, "half the facets of a rounded edge");
  }
  TriangleMesh Build(const std::string& place) const {
    if (radius_m == 0.0) return MakeBox(AsVector(size));
    const double limit_m = 0.5 * AsVector(size).minCoeff();
    if (radius_m >= limit_m) {
      throw InputError(place, fmt::format("radius_m is '{}', must be less than half the smallest "
                                          "side, {}",
                                          radius_m, limit_m));
    }
    return MakeRoundedBox(AsVector(size), radius_m, segments);
  }
};

struct CylinderItem {
  double radius_m = 0.5;
  double height_m = 1.0;
  int segments = 32;
  void Visit(OptionsVisitor& v) {
    v.Number("radius_m", radius_m, kLength, "radius at the foot");
    v.Number("height_m", height_m, kLength, "height");
    v.Number("segments", segments, kFacets, "facets around");
  }
  TriangleMesh Build(const std::string&) const {
    return Revolve(FrustumOutline(radius_m, radius_m, height_m), segments);
  }
};

struct ConeItem {
  double radius_m = 0.5;
  double top_radius_m = 0.0;
  double height_m = 1.0;
  int segments = 32;
  void Visit(OptionsVisitor& v) {
    v.Number("radius_m", radius_m, kLength, "radius at the foot");
    v.Number("top_radius_m", top_radius_m, kRadiusOrTip, "radius at the top; 0 is a tip");
    v.Number("height_m", height_m, kLength, "height");
    v.Number("segments", segments, kFacets, "facets around");
  }
  TriangleMesh Build(const std::string&) const {
    return Revolve(FrustumOutline(radius_m, top_radius_m, height_m), segments);
  }
};

struct SphereItem {
  double radius_m = 0.5;
  int segments = 32;
  void Visit(OptionsVisitor& v) {
    v.Number("radius_m", radius_m, kLength, "radius");
    v.Number("segments", segments, {4, 512}, "facets around; half as many from pole to pole");
  }
  TriangleMesh Build(const std::string&) const {
    return Revolve(SphereOutline(radius_m, segments), segments);
  }
};

struct SuperellipsoidItem {
  std::array<double, 3> size = {1, 1, 1};
  double upright = 1.0;
  double level = 1.0;
  int segments = 32;
  void Visit(OptionsVisitor& v) {
    v.Tuple("size", size, kLength, "full length along x, y, z, metres");
    v.Number("upright", upright, {0.1, 2.0}, "side outline: 1 ellipse, towards 0 a rectangle");
    v.Number("level", level, {0.1, 2.0}, "outline from above: 1 ellipse, towards 0 a rectangle");
    v.Number("segments", segments, {4, 512}, "facets around; half as many from pole to pole");
  }
  TriangleMesh Build(const std::string&) const {
    return MakeSuperellipsoid(AsVector(size), upright, level, segments);
  }
};

struct TorusItem {
  double radius_m = 0.5;
  double tube_radius_m = 0.05;
  int segments = 32;
  int tube_segments = 16;
  void Visit(OptionsVisitor& v) {
    v.Number("radius_m", radius_m, kLength, "of the tube's centre line");
    v.Number("tube_radius_m", tube_radius_m, kLength, "of the tube; below radius_m");
    v.Number("segments", segments, kFacets, "facets around the ring");
    v.Number("tube_segments", tube_segments, kFacets, "facets around the tube");
  }
  TriangleMesh Build(const std::string& place) const {
    if (tube_radius_m >= radius_m) {
      throw InputError(place, fmt::format("tube_radius_m is '{}', must be less than radius_m, {}",
                                          tube_radius_m, radius_m));
    }
    return Revolve(TorusOutline(radius_m, tube_radius_m, tube_segments), segments);
  }
};

}  // namespace depthgrid
