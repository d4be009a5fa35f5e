#include "mapper/scan/bearing_lines.h"

#include <algorithm>
#include <array>
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

// Bearings that are worked out together, so that the compiler can vectorise each step.
constexpr std::size_t kBatch = 32;
using Numbers = std::array<double, kBatch>;
struct Linears {
  Numbers at_zero, slope;
  Linear operator[](std::size_t k) const { return {at_zero[k], slope[k]}; }
};

// The lines of some bearings, before rows are chosen.
struct BatchLines {
  Numbers across;  // how much faster than rows a column leaves the bearing
  Linears horizontal, height, column;
};

// Of a function of rays, f . (a, b, 1), along rows; a is linear in b = (v - cy) / fy.
struct Slopes {
  double a_at_b0, a_slope, b_per_row, cy_px;
};
inline Linear AlongRows(double fx, double fy, double f1, const Slopes& s) {
  const double slope = (fx * s.a_slope + fy) * s.b_per_row;
  return {fx * s.a_at_b0 + f1 - slope * s.cy_px, slope};
}

void FindLines(const Axes& axes, const Bearing* bearings, std::size_t count, BatchLines& lines) {
  const Eigen::Matrix3d& m = axes.level_from_ray;
  const Eigen::RowVector3d ahead = m.row(0), left = m.row(1), up = m.row(2);
  const double b_per_row = 1.0 / axes.fy_px;
  Numbers cosine, sine;
  for (std::size_t k = 0; k < kBatch; ++k) {
    cosine[k] = bearings[std::min(k, count - 1)].cosine;
    sine[k] = bearings[std::min(k, count - 1)].sine;
  }
  for (std::size_t k = 0; k < kBatch; ++k) {
    const double c = cosine[k], s = sine[k];
    const auto off_plane = [&](int i) { return -s * ahead[i] + c * left[i]; };
    const auto along = [&](int i) { return c * ahead[i] + s * left[i]; };
    // off_plane . (a, b, 1) = 0, so a is linear in b and all else with it.
    const double inverse = -1.0 / off_plane(0);
    const Slopes slopes{off_plane(2) * inverse, off_plane(1) * inverse, b_per_row, axes.cy_px};
    const Linear horizontal = AlongRows(along(0), along(1), along(2), slopes);
    const Linear height = AlongRows(up[0], up[1], up[2], slopes);
    const double u_slope = axes.fx_px * slopes.a_slope * b_per_row;
    lines.across[k] = off_plane(0);
    lines.horizontal.at_zero[k] = horizontal.at_zero;
    lines.horizontal.slope[k] = horizontal.slope;
    lines.height.at_zero[k] = height.at_zero;
    lines.height.slope[k] = height.slope;
    lines.column.at_zero[k] = axes.cx_px + axes.fx_px * slopes.a_at_b0 - u_slope * axes.cy_px;
    lines.column.slope[k] = u_slope;
  }
}

BearingLine LineOf(const Axes& axes, const BatchLines& lines, std::size_t k) {
  BearingLine line;
  constexpr double kParallel = 1e-9;
  if (std::abs(lines.across[k]) < kParallel) return line;
  const Linear horizontal = lines.horizontal[k], height = lines.height[k], column = lines.column[k];
  double low = 0.0;
  double high = axes.height_px - 1.0;
  ClipBelow(horizontal, kMinHorizontal, low, high);
  ClipBelow(column, -0.5, low, high);
  ClipBelow({-column.at_zero, -column.slope}, -(axes.width_px - 0.5), low, high);
  line.first_row = static_cast<int>(std::ceil(std::clamp(low, -1.0, 1.0 * axes.height_px)));
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

const std::vector<Bearing>& ScanBearings(const PinholeCamera& camera,
                                         const Eigen::Quaterniond& level_from_camera, int beams,
                                         BearingFan& fan) {
  const bool transposed = LinesRunAlongRows(camera, level_from_camera);
  const Axes axes = AxesOf(camera, level_from_camera, transposed);
  // The image's borders are half a pixel beyond the outer pixels' centres; left is positive, and
  // to the left columns decrease unless the camera is upside down.
  const double left_per_a = axes.level_from_ray(1, 0) < 0.0 ? -1.0 : 1.0;
  const double first_rad = std::atan(left_per_a * (-0.5 - axes.cx_px) / axes.fx_px);
  const double last_rad = std::atan(left_per_a * (axes.width_px - 0.5 - axes.cx_px) / axes.fx_px);
  const double right_rad = std::min(first_rad, last_rad);
  const double step_rad = std::abs(last_rad - first_rad) / beams;
  const auto count = static_cast<std::size_t>(beams);
  if (fan.bearings.size() == count && fan.right_rad == right_rad && fan.step_rad == step_rad) {
    return fan.bearings;
  }
  fan.right_rad = right_rad;
  fan.step_rad = step_rad;
  const double first_angle_rad = right_rad + 0.5 * step_rad;
  // Each direction is the one before, turned by a step: a thousand steps err by 1e-13.
  const double step_cosine = std::cos(step_rad);
  const double step_sine = std::sin(step_rad);
  Bearing bearing{first_angle_rad, std::cos(first_angle_rad), std::sin(first_angle_rad)};
  fan.bearings.clear();
  fan.bearings.reserve(count);
  for (int k = 0; k < beams; ++k) {
    fan.bearings.push_back(bearing);
    bearing = {right_rad + (k + 1.5) * step_rad,
               step_cosine * bearing.cosine - step_sine * bearing.sine,
               step_sine * bearing.cosine + step_cosine * bearing.sine};
  }
  return fan.bearings;
}

std::vector<BearingLine> BearingLines(const PinholeCamera& camera,
                                      const Eigen::Quaterniond& level_from_camera,
                                      const std::vector<Bearing>& bearings, bool transposed,
                                      std::vector<BearingLine> memory) {
  const Axes axes = AxesOf(camera, level_from_camera, transposed);
  std::vector<BearingLine> lines = std::move(memory);
  lines.resize(bearings.size());
  BatchLines batch;
  for (std::size_t begin = 0; begin < bearings.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, bearings.size() - begin);
    FindLines(axes, &bearings[begin], count, batch);
    for (std::size_t k = 0; k < count; ++k) lines[begin + k] = LineOf(axes, batch, k);
  }
  return lines;
}

}  // namespace depthgrid
