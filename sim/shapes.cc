#include "sim/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <utility>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "sim/box.h"
#include "sim/revolve.h"
#include "sim/scene_limits.h"
#include "sim/superellipsoid.h"
#include "sim/sweep_shapes.h"
#include "sim/wall.h"

namespace depthgrid {
namespace {

constexpr Interval kCoordinate = {-kMaxSceneExtentM, kMaxSceneExtentM};
constexpr Interval kLength = {1e-4, kMaxSceneExtentM};  // a tenth of a millimetre: paper
constexpr Interval kRadiusOrTip = {0.0, kMaxSceneExtentM};
constexpr Interval kSegments = {3, 512};
constexpr Interval kSmooth = {0, 5};

Eigen::Vector3d AsVector(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

// Points of two coordinates from the numbers Rows() gives.
std::vector<Eigen::Vector2d> PointsOf(const std::vector<double>& numbers) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    points.emplace_back(numbers[i], numbers[i + 1]);
  }
  return points;
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
  double top_radius_m = -1.0;
  double height_m = 1.0;
  int segments = 32;
  void Visit(OptionsVisitor& v) {
    v.Number("radius_m", radius_m, kLength, "radius at the foot");
    v.Number("height_m", height_m, kLength, "height");
    v.Number("segments", segments, kSegments, "facets around");
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
    v.Number("segments", segments, kSegments, "facets around");
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
    v.Number("segments", segments, kSegments, "facets around the ring");
    v.Number("tube_segments", tube_segments, kSegments, "facets around the tube");
  }
  TriangleMesh Build(const std::string& place) const {
    if (tube_radius_m >= radius_m) {
      throw InputError(place, fmt::format("tube_radius_m is '{}', must be less than radius_m, {}",
                                          tube_radius_m, radius_m));
    }
    return Revolve(TorusOutline(radius_m, tube_radius_m, tube_segments), segments);
  }
};

struct LatheItem {
  std::vector<double> outline;
  int smooth = 0;
  int segments = 32;
  void Visit(OptionsVisitor& v) {
    v.Rows("outline", outline, 2, kCoordinate, "[radius, height] corners of a closed outline");
    v.Number("smooth", smooth, kSmooth, "rounds of corner cutting");
    v.Number("segments", segments, kSegments, "facets around");
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
    return Revolve(CutCorners(corners, smooth), segments);
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
    const Polygon rounded = CutCorners(corners, smooth);
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
    v.Number("segments", segments, kSegments, "facets around");
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
    for (std::size_t i = 0; i + 1 < tube.path.size(); ++i) {
      if (tube.path[i] == tube.path[i + 1]) {
        throw InputError(place, "path has the same point twice in a row");
      }
    }
    return MakeTube(tube);
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

// Both an item and its common keys in one reading, so that an unknown key is found among both.
template <typename Shape>
struct WithItem {
  ItemOptions item;
  Shape shape;
  void Visit(OptionsVisitor& v) {
    item.Visit(v);
    shape.Visit(v);
  }
};

template <typename Shape>
BuiltItem BuildAs(const Config& config) {
  WithItem<Shape> read;
  config.Read(read);
  return {read.item, read.shape.Build(config.Place())};
}

struct OpeningItem {
  WallOpening opening;
  void Visit(OptionsVisitor& v) {
    v.Number("along_m", opening.along_m, {0.0, kMaxSceneExtentM}, "from `from` to the near edge");
    v.Number("bottom_m", opening.bottom_m, {0.0, kMaxSceneExtentM}, "above the wall's foot");
    v.Number("width_m", opening.width_m, kLength, "width");
    v.Number("height_m", opening.height_m, kLength, "height");
  }
};

enum class WallSide { kCentre, kLeft, kRight };

struct WallItem {
  std::array<double, 2> from = {0, 0};
  std::array<double, 2> to = {1, 0};
  double height_m = 2.5;
  double thickness_m = 0.1;
  WallSide side = WallSide::kCentre;
  void Visit(OptionsVisitor& v) {
    v.Tuple("from", from, kCoordinate, "[x, y] where the wall starts");
    v.Tuple("to", to, kCoordinate, "[x, y] where it ends");
    v.Number("height_m", height_m, kLength, "height");
    v.Number("thickness_m", thickness_m, kLength, "thickness");
    v.Choice(
        "side", side,
        {{WallSide::kCentre, "centre"}, {WallSide::kLeft, "left"}, {WallSide::kRight, "right"}},
        "of the line from-to on which the wall's body lies");
  }
};

// Numbers typed with two decimals and added up may stick out by rounding.
constexpr double kOpeningSlackM = 1e-9;

BuiltItem BuildWall(Config config) {
  std::vector<WallOpening> openings;
  const auto opening_configs = config.TakeMaps("openings");
  WithItem<WallItem> read;
  config.Read(read);
  const WallItem& wall = read.shape;
  const Eigen::Vector2d from(wall.from[0], wall.from[1]);
  const Eigen::Vector2d along = Eigen::Vector2d(wall.to[0], wall.to[1]) - from;
  const double length_m = along.norm();
  if (length_m < kLength.low) throw InputError(config.Place(), "the wall's from and to coincide");
  for (const auto& opening_config : opening_configs) {
    OpeningItem item;
    opening_config.Read(item);
    const WallOpening& o = item.opening;
    if (o.along_m + o.width_m > length_m + kOpeningSlackM ||
        o.bottom_m + o.height_m > wall.height_m + kOpeningSlackM) {
      throw InputError(
          opening_config.Place(),
          fmt::format("the opening ends {} m along and {} m up, must lie within the "
                      "wall of {} x {} m",
                      o.along_m + o.width_m, o.bottom_m + o.height_m, length_m, wall.height_m));
    }
    openings.push_back(o);
  }
  const double right_y_m = wall.side == WallSide::kLeft    ? 0.0
                           : wall.side == WallSide::kRight ? -wall.thickness_m
                                                           : -0.5 * wall.thickness_m;
  const TriangleMesh straight =
      MakeWall(length_m, wall.height_m, right_y_m, wall.thickness_m, openings);
  if (straight.triangles.empty()) throw InputError(config.Place(), "the openings leave no wall");
  Eigen::Affine3d placed = Eigen::Affine3d::Identity();
  placed.translate(Eigen::Vector3d(from.x(), from.y(), 0.0));
  placed.rotate(Eigen::AngleAxisd(std::atan2(along.y(), along.x()), Eigen::Vector3d::UnitZ()));
  return {read.item, Transformed(straight, placed)};
}

using Builder = std::function<BuiltItem(const Config&)>;

const std::vector<std::pair<std::string, Builder>>& Builders() {
  static const std::vector<std::pair<std::string, Builder>> builders = {
      {"box", BuildAs<BoxItem>},     {"cylinder", BuildAs<CylinderItem>},
      {"cone", BuildAs<ConeItem>},   {"sphere", BuildAs<SphereItem>},
      {"torus", BuildAs<TorusItem>}, {"superellipsoid", BuildAs<SuperellipsoidItem>},
      {"lathe", BuildAs<LatheItem>}, {"prism", BuildAs<PrismItem>},
      {"tube", BuildAs<TubeItem>},   {"curtain", BuildAs<CurtainItem>},
      {"leaf", BuildAs<LeafItem>},   {"wall", BuildWall},
  };
  return builders;
}

}  // namespace

void ItemOptions::Visit(OptionsVisitor& v) {
  v.Text("shape", shape, "kind of shape");
  v.Text("material", material, "name of a material of this file");
  v.Tuple("at", at, kCoordinate, "where the shape's origin goes, metres");
  v.Tuple("rpy_deg", rpy_deg, {-360, 360}, "turn about x, then y, then z");
  v.Number("yaw_deg", yaw_deg, {-360, 360}, "turn about z, added to rpy_deg");
  v.Number("scale", scale, {1e-4, 1e4}, "size factor");
  v.Number("count", count, {1, 10000}, "how many, each a step further");
  v.Tuple("step", step, kCoordinate, "shift from one to the next, metres");
  v.Number("step_yaw_deg", step_yaw_deg, {-360, 360}, "turn from one to the next");
}

std::vector<std::string> ShapeNames() {
  std::vector<std::string> names;
  for (const auto& [name, builder] : Builders()) names.push_back(name);
  return names;
}

BuiltItem BuildShape(const std::string& shape, const Config& config) {
  for (const auto& [name, builder] : Builders()) {
    if (name == shape) return builder(config);
  }
  Require(false, "the shape's name is one of ShapeNames()");
  return {};
}

std::vector<Eigen::Affine3d> PlacementsOf(const ItemOptions& item) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  Eigen::Affine3d placement = Eigen::Affine3d::Identity();
  placement.translate(AsVector(item.at));
  placement.rotate(AngleAxisd(RadFromDeg(item.rpy_deg[2] + item.yaw_deg), Vector3d::UnitZ()) *
                   AngleAxisd(RadFromDeg(item.rpy_deg[1]), Vector3d::UnitY()) *
                   AngleAxisd(RadFromDeg(item.rpy_deg[0]), Vector3d::UnitX()));
  placement.scale(item.scale);
  Eigen::Affine3d step = Eigen::Affine3d::Identity();
  step.translate(AsVector(item.step));
  step.rotate(AngleAxisd(RadFromDeg(item.step_yaw_deg), Vector3d::UnitZ()));
  std::vector<Eigen::Affine3d> placements;
  for (int i = 0; i < item.count; ++i) {
    placements.push_back(placement);
    placement = step * placement;
  }
  return placements;
}

}  // namespace depthgrid
