#include "sim/shapes/wall_item.h"

#include <fmt/format.h>

#include <cmath>

#include "mapper/core/error.h"
#include "sim/shapes/wall.h"

namespace depthgrid {
namespace {

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

// Tolerance for sums of decimal numbers that exceed the wall by rounding.
constexpr double kOpeningSlackM = 1e-9;

}  // namespace

BuiltItem BuildWall(Config& config) {
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

}  // namespace depthgrid
