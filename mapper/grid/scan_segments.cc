#include "mapper/grid/scan_segments.h"

#include <algorithm>
#include <cmath>

#include "mapper/grid/ray.h"

namespace depthgrid {

const ScanSegments& SegmentBuilder::Build(const Scan& scan, const Pose2& map_from_base,
                                          double resolution_m, double clear_margin_m) {
  UpdateDirections(scan);
  Unpack(scan, clear_margin_m);
  Place(map_from_base, resolution_m);
  Bound();
  return segments_;
}

void SegmentBuilder::UpdateDirections(const Scan& scan) {
  const std::size_t count = scan.beams.size();
  bool same = bearing_rad_.size() == count;
  for (std::size_t i = 0; same && i < count; ++i) {
    same = bearing_rad_[i] == scan.beams[i].bearing_rad;
  }
  if (same) return;
  bearing_rad_.resize(count);
  cos_.resize(count);
  sin_.resize(count);
  segments_.bearings_increase = true;
  for (std::size_t i = 0; i < count; ++i) {
    bearing_rad_[i] = scan.beams[i].bearing_rad;
    cos_[i] = std::cos(static_cast<double>(bearing_rad_[i]));
    sin_[i] = std::sin(static_cast<double>(bearing_rad_[i]));
    if (i > 0 && bearing_rad_[i] <= bearing_rad_[i - 1]) segments_.bearings_increase = false;
  }
  if (count > 0 && bearing_rad_.back() - bearing_rad_.front() >= 2.0 * kPi) {
    segments_.bearings_increase = false;
  }
}

void SegmentBuilder::Unpack(const Scan& scan, double clear_margin_m) {
  const std::size_t count = scan.beams.size();
  clear_from_m_.resize(count);
  clear_to_m_.resize(count);
  range_m_.resize(count);
  segments_.hit.resize(count);
  segments_.clears.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Beam& beam = scan.beams[i];
    const double clear_to_m = beam.clear_to_m;
    const double range_m = beam.range_m;
    const double stop_m = beam.hit ? std::min(clear_to_m, range_m - clear_margin_m) : clear_to_m;
    const bool clears = stop_m > static_cast<double>(beam.clear_from_m);
    segments_.hit[i] = beam.hit ? 1 : 0;
    segments_.clears[i] = clears ? 1 : 0;
    range_m_[i] = beam.hit ? range_m : 0.0;
    clear_from_m_[i] = clears ? static_cast<double>(beam.clear_from_m) : 0.0;
    clear_to_m_[i] = clears ? stop_m : 0.0;
  }
}

void SegmentBuilder::Place(const Pose2& map_from_base, double resolution_m) {
  const std::size_t count = range_m_.size();
  for (auto* values : {&segments_.from_x, &segments_.from_y, &segments_.to_x, &segments_.to_y,
                       &segments_.end_x, &segments_.end_y}) {
    values->resize(count);
  }
  segments_.origin = map_from_base.translation() / resolution_m;
  const double origin_x = segments_.origin.x();
  const double origin_y = segments_.origin.y();
  const double c = std::cos(map_from_base.yaw_rad) / resolution_m;
  const double s = std::sin(map_from_base.yaw_rad) / resolution_m;
  for (std::size_t i = 0; i < count; ++i) {
    const double x_per_m = c * cos_[i] - s * sin_[i];
    const double y_per_m = s * cos_[i] + c * sin_[i];
    segments_.from_x[i] = origin_x + clear_from_m_[i] * x_per_m;
    segments_.from_y[i] = origin_y + clear_from_m_[i] * y_per_m;
    segments_.to_x[i] = origin_x + clear_to_m_[i] * x_per_m;
    segments_.to_y[i] = origin_y + clear_to_m_[i] * y_per_m;
    segments_.end_x[i] = origin_x + range_m_[i] * x_per_m;
    segments_.end_y[i] = origin_y + range_m_[i] * y_per_m;
  }
}

void SegmentBuilder::Bound() {
  Eigen::Vector2d low = segments_.origin;
  Eigen::Vector2d high = segments_.origin;
  const auto include = [&](const std::vector<double>& xs, const std::vector<double>& ys) {
    double low_x = low.x(), low_y = low.y(), high_x = high.x(), high_y = high.y();
    for (std::size_t i = 0; i < xs.size(); ++i) {
      low_x = xs[i] < low_x ? xs[i] : low_x;
      high_x = xs[i] > high_x ? xs[i] : high_x;
      low_y = ys[i] < low_y ? ys[i] : low_y;
      high_y = ys[i] > high_y ? ys[i] : high_y;
    }
    low = {low_x, low_y};
    high = {high_x, high_y};
  };
  include(segments_.from_x, segments_.from_y);
  include(segments_.to_x, segments_.to_y);
  include(segments_.end_x, segments_.end_y);
  // Rounding where a segment crosses a row can put it a hair outside its end points' cells.
  segments_.min_cell = {FloorToInt(low.x()) - 1, FloorToInt(low.y())};
  segments_.max_cell = {FloorToInt(high.x()) + 1, FloorToInt(high.y())};
}

}  // namespace depthgrid
