// Solids of revolution, prisms, tubes, curtains and leaves in scene files: keys, defaults and
// meshes. Internal to sim/shapes/shapes.cc.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "mapper/core/error.h"
#include "sim/mesh/polygon.h"
#include "sim/shapes/corner_cutting.h"
#include "sim/shapes/item_options.h"
#include "sim/shapes/revolve.h"
#include "sim/shapes/sweep_shapes.h"

namespace depthgrid {

constexpr Interval kSmooth = {0, 5};

// Points of two coordinates from the numbers Rows() gives.
inline std::vector<Eigen::Vector2d> PointsOf(const std::vector<double>& numbers) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    points.emplace_back(numbers[i], numbers[i + 1]);
  }
  return points;
}

struct LatheItem {
  std::vector<double> outline;
  int smooth = 0;
  int segments = 32;
  void Visit(OptionsVisitor& v) {
    v.Rows("outline", outline, 2, kCoordinate, "[radius, height] corners of a closed outline");
    v.Number("smooth", smooth, kSmooth, "rounds of corner cutting");
    v.Number("segments", segments, kFacets, "facets around");
  }
  TriangleMesh Build(const std::string& place) const {
    const LatheOutline corners = PointsOf(outline);
    for (const auto& corner : corners) {
      if (corner.x() < 0.0) {
        throw InputError(
            place, fmt::format("outline has the radius '{}', must be at least 0", corner.x()));
      }
    }
    if (!IsSimple(corners)) {
      throw InputError(place, "outline must have three corners or more and not cross itself");
    }
    // A corner on the axis is not a corner of the solid: cutting it would leave a pit there.
    const auto is_on_axis = [](const Eigen::Vector2d& corner) { return corner.x() == 0.0; };
    return Revolve(CutCorners(corners, smooth, true, is_on_axis), segments);
  }
};

struct PrismItem {
  std::vector<double> outline;
  double height_m = 1.0;
  int smooth = 0;
  void Visit(OptionsVisitor& v) {
    v.Rows("outline", outline, 2, kCoordinate, "[x, y] corners of a closed outline");
    v.Number("height_m", height_m, kLength, "height");
    v.Number("smooth", smooth, kSmooth, "rounds of corner cutting");
  }
  TriangleMesh Build(const std::string& place) const {
    constexpr std::size_t kMaxCorners = 1024;  // clipping ears is quadratic
    const Polygon corners = PointsOf(outline);
    if (corners.size() << static_cast<unsigned>(smooth) > kMaxCorners) {
      throw InputError(place, fmt::format("outline has {} corners and smooth is {}: more than {} "
                                          "corners in the end",
                                          corners.size(), smooth, kMaxCorners));
    }
    const Polygon rounded = CutCorners(corners, smooth, true);
    if (!IsSimple(corners) || !IsSimple(rounded)) {
      throw InputError(place, "outline must have three corners or more and not cross itself");
    }
    return MakePrism(rounded, height_m);
  }
};

struct TubeItem {
  std::vector<double> path;
  double radius_m = 0.01;
  double end_radius_m = -1.0;
  bool closed = false;
  int smooth = 0;
  int segments = 12;
  void Visit(OptionsVisitor& v) {
    v.Rows("path", path, 3, kCoordinate, "[x, y, z] points of the centre line");
    v.Number("radius_m", radius_m, kLength, "radius at the start");
    v.Number("end_radius_m", end_radius_m, {-1.0, kMaxSceneExtentM},
             "radius at the end; -1 is radius_m");
    v.Flag("closed", closed, "the last point joins the first");
    v.Number("smooth", smooth, kSmooth, "rounds of corner cutting");
    v.Number("segments", segments, kFacets, "facets around");
  }
  TriangleMesh Build(const std::string& place) const {
    TubeShape tube{{},     radius_m, end_radius_m < 0.0 ? radius_m : end_radius_m,
                   closed, smooth,   segments};
    for (std::size_t i = 0; i + 2 < path.size(); i += 3) {
      tube.path.emplace_back(path[i], path[i + 1], path[i + 2]);
    }
    const std::size_t least = closed ? 3 : 2;
    if (tube.path.size() < least) {
      throw InputError(
          place, fmt::format("path has {} points, must have at least {}", tube.path.size(), least));
    }
    RequireWay(tube, place);
    return MakeTube(tube);
  }
  // Requires that neighbouring points differ and that no edge reverses the one before.
  static void RequireWay(const TubeShape& tube, const std::string& place) {
    constexpr double kStraightBackCos = -1.0 + 1e-9;
    const std::size_t count = tube.path.size();
    const std::size_t edges = tube.closed ? count : count - 1;
    const auto edge = [&](std::size_t i) -> Eigen::Vector3d {
      return tube.path[(i + 1) % count] - tube.path[i % count];
    };
    for (std::size_t i = 0; i < edges; ++i) {
      if (edge(i).norm() == 0.0) throw InputError(place, "path has the same point twice in a row");
    }
    for (std::size_t i = 0; i + (tube.closed ? 0 : 1) < edges; ++i) {
      if (edge(i).normalized().dot(edge(i + 1).normalized()) > kStraightBackCos) continue;
      const Eigen::Vector3d& at = tube.path[(i + 1) % count];
      throw InputError(
          place, fmt::format("path turns straight back at [{}, {}, {}]", at.x(), at.y(), at.z()));
    }
  }
};

struct CurtainItem {
  CurtainShape curtain;
  void Visit(OptionsVisitor& v) {
    v.Number("width_m", curtain.width_m, kLength, "width along x");
    v.Number("height_m", curtain.height_m, kLength, "height");
    v.Number("depth_m", curtain.depth_m, kLength, "from crest to trough");
    v.Number("thickness_m", curtain.thickness_m, kLength, "of the cloth");
    v.Number("folds", curtain.folds, {1, 200}, "whole waves");
    v.Number("segments", curtain.segments, {4, 64}, "facets a fold");
  }
  TriangleMesh Build(const std::string&) const { return MakeCurtain(curtain); }
};

struct LeafItem {
  LeafShape leaf;
  void Visit(OptionsVisitor& v) {
    v.Number("length_m", leaf.length_m, kLength, "from base to tip, along the blade");
    v.Number("width_m", leaf.width_m, kLength, "at the widest");
    v.Number("thickness_m", leaf.thickness_m, kLength, "of the blade");
    v.Number("bend_deg", leaf.bend_deg, {-180, 180}, "how far the tip points further down");
    v.Number("segments", leaf.segments, {3, 64}, "facets from base to tip");
  }
  TriangleMesh Build(const std::string&) const { return MakeLeaf(leaf); }
};

}  // namespace depthgrid
