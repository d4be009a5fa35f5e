#include "mapper/scan/bearing_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace depthgrid {
namespace {

using internal::BlockDirections;
using internal::ImageAxes;

ImageAxes AxesOf(const PinholeCamera& camera, const Eigen::Quaterniond& level_from_camera,
                 bool transposed) {
  ImageAxes axes{level_from_camera.toRotationMatrix(),
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

}  // namespace

bool LinesRunAlongRows(const PinholeCamera& camera, const Eigen::Quaterniond& level_from_camera) {
  // Whether the line of bearing 0 moves by more than one column per row.
  const Eigen::RowVector3d off_plane = level_from_camera.toRotationMatrix().row(1);
  return std::abs(off_plane.y()) * camera.fx_px > std::abs(off_plane.x()) * camera.fy_px;
}

const std::vector<Bearing>& ScanBearings(const PinholeCamera& camera,
                                         const Eigen::Quaterniond& level_from_camera, int beams,
                                         BearingFan& fan) {
  const bool transposed = LinesRunAlongRows(camera, level_from_camera);
  const ImageAxes axes = AxesOf(camera, level_from_camera, transposed);
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
  // Each direction is the previous one rotated by a step; the error is 1e-13 after a thousand
  // steps.
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

BearingLine BearingLineTable::operator[](std::size_t k) const {
  const BearingLineBlock& block = blocks[k / kBlockBearings];
  const std::size_t i = k % kBlockBearings;
  return {block.u0[i],
          block.u1[i],
          block.h0[i],
          block.h1[i],
          block.g0[i],
          block.g1[i],
          static_cast<int>(block.first_row[i]),
          static_cast<int>(block.last_row[i])};
}

BearingLineTable BearingLines(const PinholeCamera& camera,
                              const Eigen::Quaterniond& level_from_camera,
                              const std::vector<Bearing>& bearings, bool transposed,
                              BearingLineTable memory) {
  const ImageAxes axes = AxesOf(camera, level_from_camera, transposed);
  BearingLineTable lines = std::move(memory);
  lines.Resize(bearings.size());
  BlockDirections directions;
  for (std::size_t b = 0; b < lines.blocks.size(); ++b) {
    for (std::size_t i = 0; i < kBlockBearings; ++i) {
      const Bearing& bearing = bearings[std::min(b * kBlockBearings + i, bearings.size() - 1)];
      directions.cosine[i] = bearing.cosine;
      directions.sine[i] = bearing.sine;
    }
    internal::FindLines(axes, directions, lines.blocks[b]);
  }
  return lines;
}

}  // namespace depthgrid
