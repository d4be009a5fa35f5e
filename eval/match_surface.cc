#include "eval/match_surface.h"

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

double RmsResidual(const MatchPoints& points, const ProbabilityView& view,
                   const Pose2& map_from_base) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.x_m.size(); ++i) {
    const Eigen::Vector2d point_in_map =
        map_from_base * Eigen::Vector2d(points.x_m[i], points.y_m[i]);
    const double residual = 1.0 - SampleBicubic(view, point_in_map).value;
    sum += residual * residual;
  }
  return points.size() > 0 ? std::sqrt(sum / points.size()) : 0.0;
}

}  // namespace

MatchSurface MatchSurfaceAround(const MatchPoints& points, const ProbabilityView& view,
                                const Pose2& map_from_base, const MatchSurfaceOptions& options) {
  const MatchPoints thinned = EveryNth(points, options.most_points);
  MatchSurface surface;
  surface.step_m = options.step_m;
  surface.half_steps = static_cast<int>(std::lround(options.half_window_m / options.step_m));
  Pose2 pose = map_from_base;
  for (int y = -surface.half_steps; y <= surface.half_steps; ++y) {
    for (int x = -surface.half_steps; x <= surface.half_steps; ++x) {
      pose.x_m = map_from_base.x_m + x * options.step_m;
      pose.y_m = map_from_base.y_m + y * options.step_m;
      surface.residual.push_back(RmsResidual(thinned, view, pose));
    }
  }
  surface.yaw_step_rad = options.yaw_step_rad;
  const int half_yaws =
      static_cast<int>(std::lround(options.half_window_rad / options.yaw_step_rad));
  for (int i = -half_yaws; i <= half_yaws; ++i) {
    surface.yaw_residual.push_back(RmsResidual(
        thinned, view,
        {map_from_base.x_m, map_from_base.y_m, map_from_base.yaw_rad + i * options.yaw_step_rad}));
  }
  return surface;
}

}  // namespace depthgrid
