#include "mapper/scan/bearing_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace depthgrid {
namespace {

// Rays closer than this to vertical have no useful bearing (sine of 3 degrees).
constexpr double kMinHorizontal = 0.05;

// value = at_zero + slope * v.
struct Linear {
  double at_zero = 0.0;
  double slope = 0.0;
  double operator()(double v) const { return at_zero + slope * v; }
};

// Rows of [low, high] where `function` >= limit.
void ClipBelow(const Linear& function, double limit, double& low, double& high) {
  if (function(low) >= limit && function(high) >= limit) return;  // most: no division
  if (function.slope == 0.0) {
    if (function.at_zero < limit) high = low - 1.0;
    return;
  }
  const double root = (limit - function.at_zero) / function.slope;
  if (function.slope > 0.0) {
    low = std::max(low, root);
  } else {
    high = std::min(high, root);
  }
}

// The camera as the (possibly transposed) image has it: rows of the matrix are forward, left and up
// of a ray (a, b, 1), a along the image's columns and b along its rows.
struct Axes {
  Eigen::Matrix3d level_from_ray;
  double fx_px, fy_px, cx_px, cy_px;
  int width_px, height_px;
};

Axes AxesOf(const PinholeCamera& camera, const Eigen::Quaterniond& level_from_camera,
            bool transposed) {
  Axes axes{level_from_camera.toRotationMatrix(),
            camera.fx_px,
            camera.fy_px,
            camera.cx_px,
            camera.cy_px,
            camera.width_px,
            camera.height_px};
  if (transposed) {
    axes.level_from_ray.col(0).swap(axes.level_from_ray.col(1));
    std::swap(axes.fx_px, axes.fy_px);
    std::swap(axes.cx_px, axes.cy_px);
    std::swap(axes.width_px, axes.height_px);
  }
  return axes;
}

BearingLine LineAt(const Axes& axes, const Bearing& bearing) {
  const double c = bearing.cosine;
  const double s = bearing.sine;
  const Eigen::RowVector3d off_plane = Eigen::RowVector3d(-s, c, 0.0) * axes.level_from_ray;
  const Eigen::RowVector3d along = Eigen::RowVector3d(c, s, 0.0) * axes.level_from_ray;
  const Eigen::RowVector3d up = axes.level_from_ray.row(2);
  BearingLine line;
  constexpr double kParallel = 1e-9;
  if (std::abs(off_plane.x()) < kParallel) return line;
  // off_plane . (a, b, 1) = 0, so a is linear in b and all else with it; b = (v - cy) / fy.
  const double inverse = -1.0 / off_plane.x();
  const double a_at_b0 = off_plane.z() * inverse;
  const double a_slope = off_plane.y() * inverse;
  const double b_per_row = 1.0 / axes.fy_px;
  const auto along_rows = [&](const Eigen::RowVector3d& f) {
    const double slope = (f.x() * a_slope + f.y()) * b_per_row;
    return Linear{f.x() * a_at_b0 + f.z() - slope * axes.cy_px, slope};
  };
  const Linear horizontal = along_rows(along);
  const Linear height = along_rows(up);
  const double u_slope = axes.fx_px * a_slope * b_per_row;
  const Linear column{axes.cx_px + axes.fx_px * a_at_b0 - u_slope * axes.cy_px, u_slope};

  double low = 0.0;
  double high = axes.height_px - 1.0;
  ClipBelow(horizontal, kMinHorizontal, low, high);
  ClipBelow(column, -0.5, low, high);
  ClipBelow({-column.at_zero, -column.slope}, -(axes.width_px - 0.5), low, high);
  line.first_row = static_cast<int>(std::ceil(std::max(low, -1.0)));
  line.last_row = static_cast<int>(std::floor(std::max(high, -1.0)));
  line.u0 = static_cast<float>(column.at_zero);
  line.u1 = static_cast<float>(column.slope);
  line.h0 = static_cast<float>(horizontal.at_zero);
  line.h1 = static_cast<float>(horizontal.slope);
  line.g0 = static_cast<float>(height.at_zero);
  line.g1 = static_cast<float>(height.slope);
  return line;
}

}  // namespace

bool LinesRunAlongRows(const PinholeCamera& camera, const Eigen::Quaterniond& level_from_camera) {
  // Bearing 0: column slope of the line in pixels a row, against one.
  const Eigen::RowVector3d off_plane = level_from_camera.toRotationMatrix().row(1);
  return std::abs(off_plane.y()) * camera.fx_px > std::abs(off_plane.x()) * camera.fy_px;
}

std::vector<Bearing> ScanBearings(const PinholeCamera& camera,
                                  const Eigen::Quaterniond& level_from_camera, int beams,
                                  std::vector<Bearing> memory) {
  const bool transposed = LinesRunAlongRows(camera, level_from_camera);
  const Axes axes = AxesOf(camera, level_from_camera, transposed);
  // The image's borders are half a pixel beyond the outer pixels' centres; left is positive, and
  // to the left columns decrease unless the camera is upside down.
  const double left_per_a = axes.level_from_ray(1, 0) < 0.0 ? -1.0 : 1.0;
  const double first_rad = std::atan(left_per_a * (-0.5 - axes.cx_px) / axes.fx_px);
  const double last_rad = std::atan(left_per_a * (axes.width_px - 0.5 - axes.cx_px) / axes.fx_px);
  const double right_rad = std::min(first_rad, last_rad);
  const double step_rad = std::abs(last_rad - first_rad) / beams;
  const double first_angle_rad = right_rad + 0.5 * step_rad;
  // Each direction is the one before, turned by a step: a thousand steps err by 1e-13.
  const double step_cosine = std::cos(step_rad);
  const double step_sine = std::sin(step_rad);
  Bearing bearing{first_angle_rad, std::cos(first_angle_rad), std::sin(first_angle_rad)};
  std::vector<Bearing> bearings = std::move(memory);
  bearings.clear();
  bearings.reserve(static_cast<std::size_t>(beams));
  for (int k = 0; k < beams; ++k) {
    bearings.push_back(bearing);
    bearing = {right_rad + (k + 1.5) * step_rad,
               step_cosine * bearing.cosine - step_sine * bearing.sine,
               step_sine * bearing.cosine + step_cosine * bearing.sine};
  }
  return bearings;
}

std::vector<BearingLine> BearingLines(const PinholeCamera& camera,
                                      const Eigen::Quaterniond& level_from_camera,
                                      const std::vector<Bearing>& bearings, bool transposed,
                                      std::vector<BearingLine> memory) {
  const Axes axes = AxesOf(camera, level_from_camera, transposed);
  std::vector<BearingLine> lines = std::move(memory);
  lines.clear();
  lines.reserve(bearings.size());
  for (const Bearing& bearing : bearings) lines.push_back(LineAt(axes, bearing));
  return lines;
}

}  // namespace depthgrid
