#include "eval/metrics/spline_field.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace depthgrid {
namespace {

constexpr int kTaps = 4;

// The four cubic B-splines that are nonzero at `t` in [0, 1) past the second one's centre, with
// first and second derivatives (de Boor 1978).
struct Weights {
  std::array<double, kTaps> value, first, second;
};
Weights WeightsAt(double t) {
  const double u = 1.0 - t;
  Weights w;
  w.value = {u * u * u / 6.0, 2.0 / 3.0 - t * t + 0.5 * t * t * t,
             2.0 / 3.0 - u * u + 0.5 * u * u * u, t * t * t / 6.0};
  w.first = {-0.5 * u * u, -2.0 * t + 1.5 * t * t, 2.0 * u - 1.5 * u * u, 0.5 * t * t};
  w.second = {u, -2.0 + 3.0 * t, -2.0 + 3.0 * u, t};
  return w;
}

// Mean of the 2 radius + 1 values around each, zeros outside, along lines of `count` values
// `stride` apart.
void BoxFilter(std::vector<double>& values, std::size_t first, std::size_t stride, int count,
               int radius) {
  std::vector<double> line(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    line[static_cast<std::size_t>(i)] = values[first + stride * static_cast<std::size_t>(i)];
  }
  double sum = 0.0;
  for (int i = 0; i < std::min(radius, count); ++i) sum += line[static_cast<std::size_t>(i)];
  for (int i = 0; i < count; ++i) {
    if (i + radius < count) sum += line[static_cast<std::size_t>(i + radius)];
    values[first + stride * static_cast<std::size_t>(i)] = sum / (2.0 * radius + 1.0);
    if (i - radius >= 0) sum -= line[static_cast<std::size_t>(i - radius)];
  }
}

}  // namespace

SplineField::SplineField(const CellSet& set, int smoothing_radius_cells) {
  constexpr int kPasses = 3;
  geometry_ = Widened(set.geometry, kPasses * smoothing_radius_cells + 2);
  values_.assign(geometry_.size(), 0.0);
  for (std::size_t i = 0; i < set.members.size(); ++i) {
    if (set.members[i] != 0) values_[geometry_.Index(set.geometry.CellAt(i))] = 1.0;
  }
  if (smoothing_radius_cells == 0) return;
  const auto width = static_cast<std::size_t>(geometry_.width_cells);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (int y = 0; y < geometry_.height_cells; ++y) {
      BoxFilter(values_, width * static_cast<std::size_t>(y), 1, geometry_.width_cells,
                smoothing_radius_cells);
    }
    for (std::size_t x = 0; x < width; ++x) {
      BoxFilter(values_, x, width, geometry_.height_cells, smoothing_radius_cells);
    }
  }
}

SplineSample SplineField::At(const Eigen::Vector2d& position_cells) const {
  SplineSample sample;
  const double x = position_cells.x() - 0.5 - geometry_.min_cell.x;
  const double y = position_cells.y() - 0.5 - geometry_.min_cell.y;
  const double x_floor = std::floor(x);
  const double y_floor = std::floor(y);
  if (!(x_floor >= 1.0 && y_floor >= 1.0 && x_floor + 2.0 < geometry_.width_cells &&
        y_floor + 2.0 < geometry_.height_cells)) {
    return sample;
  }
  const Weights wx = WeightsAt(x - x_floor);
  const Weights wy = WeightsAt(y - y_floor);
  const auto column = static_cast<std::size_t>(x_floor) - 1;
  const auto row = static_cast<std::size_t>(y_floor) - 1;
  for (std::size_t j = 0; j < kTaps; ++j) {
    const double* line =
        &values_[(row + j) * static_cast<std::size_t>(geometry_.width_cells) + column];
    double value = 0.0;
    double dx = 0.0;
    double dxx = 0.0;
    for (std::size_t i = 0; i < kTaps; ++i) {
      value += wx.value[i] * line[i];
      dx += wx.first[i] * line[i];
      dxx += wx.second[i] * line[i];
    }
    sample.value += wy.value[j] * value;
    sample.gradient += Eigen::Vector2d(wy.value[j] * dx, wy.first[j] * value);
    sample.hessian(0, 0) += wy.value[j] * dxx;
    sample.hessian(0, 1) += wy.first[j] * dx;
    sample.hessian(1, 1) += wy.second[j] * value;
  }
  sample.hessian(1, 0) = sample.hessian(0, 1);
  return sample;
}

}  // namespace depthgrid
