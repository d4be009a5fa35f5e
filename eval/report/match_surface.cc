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

// The same at every offset of the window, row by row. Offsets of one column have their
// interpolation along x in common, those of one row that along y: a tenth of the time of one after
// another.
std::vector<double> RmsResiduals(const std::vector<Eigen::Vector2d>& turned,
                                 const ProbabilityView& view, const Eigen::Vector2d& centre_m,
                                 double step_m, int half_steps) {
  const auto side = static_cast<std::size_t>(2 * half_steps + 1);
  std::vector<double> sums(side * side, 0.0);
  std::vector<SplineAlongAxis> along_x(side);
  std::vector<SplineAlongAxis> along_y(side);
  std::vector<double> rows;  // of cells, interpolated along x at each offset
  for (const Eigen::Vector2d& point : turned) {
    for (std::size_t i = 0; i < side; ++i) {
      const double offset_m = (static_cast<int>(i) - half_steps) * step_m;
      const double r = view.geometry.resolution_m;
      along_x[i] = SplineAt(centre_m.x() + offset_m + point.x(), r);
      along_y[i] = SplineAt(centre_m.y() + offset_m + point.y(), r);
    }
    rows.clear();
    const int first_row = along_y.front().first_cell;
    for (int row = first_row; row < along_y.back().first_cell + 4; ++row) {
      for (const SplineAlongAxis& x : along_x) {
        double value = 0.0;
        for (int i = 0; i < 4; ++i) value += x.weights[i] * view.At({x.first_cell + i, row});
        rows.push_back(value);
      }
    }
    for (std::size_t y = 0; y < side; ++y) {
      const auto& weights = along_y[y].weights;
      const double* const cells =
          &rows[static_cast<std::size_t>(along_y[y].first_cell - first_row) * side];
      for (std::size_t x = 0; x < side; ++x) {
        const double residual =
            1.0 - (weights[0] * cells[x] + weights[1] * cells[side + x] +
                   weights[2] * cells[2 * side + x] + weights[3] * cells[3 * side + x]);
        sums[y * side + x] += residual * residual;
      }
    }
  }
  if (!turned.empty()) {
    for (double& sum : sums) sum = std::sqrt(sum / static_cast<double>(turned.size()));
  }
  return sums;
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
  surface.residual =
      RmsResiduals(turned, view, map_from_base.translation(), options.step_m, surface.half_steps);
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
