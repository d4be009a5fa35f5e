#include "eval/report/match_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mapper/match/bicubic.h"

namespace depthgrid {
namespace {

MatchPoints EveryNth(const MatchPoints& points, int most) {
  const int step = std::max(1, (points.size() + most - 1) / most);
  MatchPoints thinned;
  thinned.farthest_m = points.farthest_m;
  for (std::size_t i = 0; i < points.x_m.size(); i += static_cast<std::size_t>(step)) {
    thinned.x_m.push_back(points.x_m[i]);
    thinned.y_m.push_back(points.y_m[i]);
  }
  return thinned;
}

// Root mean square of 1 - M over points, rotated by the caller and moved by `offset_m`.
double RmsResidual(const std::vector<Eigen::Vector2d>& turned, const ProbabilityView& view,
                   const Eigen::Vector2d& offset_m) {
  double sum = 0.0;
  for (const Eigen::Vector2d& point : turned) {
    const double residual = 1.0 - BicubicValue(view, offset_m + point);
    sum += residual * residual;
  }
  return turned.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(turned.size()));
}

std::vector<Eigen::Vector2d> Turned(const MatchPoints& points, double yaw_rad) {
  const Eigen::Rotation2Dd rotation(yaw_rad);
  std::vector<Eigen::Vector2d> turned;
  for (std::size_t i = 0; i < points.x_m.size(); ++i) {
    turned.push_back(rotation * Eigen::Vector2d(points.x_m[i], points.y_m[i]));
  }
  return turned;
}

}  // namespace

MatchSurface MatchSurfaceAround(const MatchPoints& points, const ProbabilityView& view,
                                const Pose2& map_from_base, const MatchSurfaceOptions& options) {
  const MatchPoints thinned = EveryNth(points, options.most_points);
  MatchSurface surface;
  surface.step_m = options.step_m;
  surface.half_steps = static_cast<int>(std::lround(options.half_window_m / options.step_m));
  const auto turned = Turned(thinned, map_from_base.yaw_rad);
  for (int y = -surface.half_steps; y <= surface.half_steps; ++y) {
    for (int x = -surface.half_steps; x <= surface.half_steps; ++x) {
      const Eigen::Vector2d offset_m(x * options.step_m, y * options.step_m);
      surface.residual.push_back(RmsResidual(turned, view, map_from_base.translation() + offset_m));
    }
  }
  surface.yaw_step_rad = options.yaw_step_rad;
  const int half_yaws =
      static_cast<int>(std::lround(options.half_window_rad / options.yaw_step_rad));
  for (int i = -half_yaws; i <= half_yaws; ++i) {
    const double yaw_rad = map_from_base.yaw_rad + i * options.yaw_step_rad;
    surface.yaw_residual.push_back(
        RmsResidual(Turned(thinned, yaw_rad), view, map_from_base.translation()));
  }
  return surface;
}

}  // namespace depthgrid
