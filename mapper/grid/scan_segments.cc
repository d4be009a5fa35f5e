#include "mapper/grid/scan_segments.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "mapper/grid/ray.h"

namespace depthgrid {
namespace {

Eigen::Map<Eigen::ArrayXd> AsArray(std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

// Farther than any beam clears.
constexpr double kNoHitM = 1e9;

std::size_t Padded(std::size_t count) {
  return (count + kSegmentPadding - 1) / kSegmentPadding * kSegmentPadding;
}

bool SameBytes(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace

const ScanSegments& SegmentBuilder::Build(const Scan& scan, const Pose2& map_from_base,
                                          double resolution_m, double clear_margin_m) {
  Unpack(scan, clear_margin_m);
  if (!SameBytes(bearing_rad_, known_bearing_rad_)) UpdateDirections();
  Place(map_from_base, resolution_m);
  Bound();
  return segments_;
}

void SegmentBuilder::Unpack(const Scan& scan, double clear_margin_m) {
  const std::size_t count = scan.beams.size();
  bearing_rad_.resize(count);
  for (auto* values : {&clear_from_m_, &clear_to_m_, &range_m_}) {
    values->resize(Padded(count));
    std::fill(values->begin() + static_cast<std::ptrdiff_t>(count), values->end(), 0.0);
  }
  segments_.hit.resize(count);
  segments_.clears.resize(count);
  // Local pointers, because the compiler must assume that stores to bytes change members.
  std::uint8_t* const hit = segments_.hit.data();
  std::uint8_t* const clears = segments_.clears.data();
  float* const bearing_rad = bearing_rad_.data();
  double* const clear_from_m = clear_from_m_.data();
  double* const clear_to_m = clear_to_m_.data();
  double* const range_m = range_m_.data();
  const Beam* const beams = scan.beams.data();
  for (std::size_t i = 0; i < count; ++i) {
    const Beam& beam = beams[i];
    const double hit_m = beam.hit ? static_cast<double>(beam.range_m) : kNoHitM;
    const double to_m = std::min<double>(beam.clear_to_m, hit_m - clear_margin_m);
    const bool is_clear = to_m > static_cast<double>(beam.clear_from_m);
    bearing_rad[i] = beam.bearing_rad;
    clear_from_m[i] = is_clear ? static_cast<double>(beam.clear_from_m) : 0.0;
    clear_to_m[i] = is_clear ? to_m : 0.0;
    range_m[i] = beam.hit ? hit_m : 0.0;
    hit[i] = beam.hit ? 1 : 0;
    clears[i] = is_clear ? 1 : 0;
  }
}

void SegmentBuilder::UpdateDirections() {
  const std::size_t count = bearing_rad_.size();
  known_bearing_rad_ = bearing_rad_;
  cos_.assign(Padded(count), 0.0);
  sin_.assign(Padded(count), 0.0);
  segments_.bearings_increase =
      count == 0 || bearing_rad_.back() - bearing_rad_.front() < 2.0 * kPi;
  for (std::size_t i = 0; i < count; ++i) {
    cos_[i] = std::cos(static_cast<double>(bearing_rad_[i]));
    sin_[i] = std::sin(static_cast<double>(bearing_rad_[i]));
    // Written so that NaN counts as out of order.
    if (i > 0 && !(bearing_rad_[i] > bearing_rad_[i - 1])) segments_.bearings_increase = false;
  }
}

void SegmentBuilder::Place(const Pose2& map_from_base, double resolution_m) {
  const std::size_t count = range_m_.size();
  x_per_m_.resize(count);
  y_per_m_.resize(count);
  for (auto* values : {&segments_.from_x, &segments_.from_y, &segments_.to_x, &segments_.to_y,
                       &segments_.end_x, &segments_.end_y}) {
    values->resize(range_m_.size());
  }
  segments_.origin = map_from_base.translation() / resolution_m;
  const double x = segments_.origin.x();
  const double y = segments_.origin.y();
  const double c = std::cos(map_from_base.yaw_rad) / resolution_m;
  const double s = std::sin(map_from_base.yaw_rad) / resolution_m;
  AsArray(x_per_m_) = c * AsArray(cos_) - s * AsArray(sin_);
  AsArray(y_per_m_) = s * AsArray(cos_) + c * AsArray(sin_);
  AsArray(segments_.from_x) = x + AsArray(clear_from_m_) * AsArray(x_per_m_);
  AsArray(segments_.from_y) = y + AsArray(clear_from_m_) * AsArray(y_per_m_);
  AsArray(segments_.to_x) = x + AsArray(clear_to_m_) * AsArray(x_per_m_);
  AsArray(segments_.to_y) = y + AsArray(clear_to_m_) * AsArray(y_per_m_);
  AsArray(segments_.end_x) = x + AsArray(range_m_) * AsArray(x_per_m_);
  AsArray(segments_.end_y) = y + AsArray(range_m_) * AsArray(y_per_m_);
}

void SegmentBuilder::Bound() {
  Eigen::Vector2d low = segments_.origin;
  Eigen::Vector2d high = segments_.origin;
  // Near ends of clear intervals need no check: they lie between the origin and the far ends.
  if (segments_.size() > 0) {
    low = low.cwiseMin(
        Eigen::Vector2d(AsArray(segments_.to_x).min(AsArray(segments_.end_x)).minCoeff(),
                        AsArray(segments_.to_y).min(AsArray(segments_.end_y)).minCoeff()));
    high = high.cwiseMax(
        Eigen::Vector2d(AsArray(segments_.to_x).max(AsArray(segments_.end_x)).maxCoeff(),
                        AsArray(segments_.to_y).max(AsArray(segments_.end_y)).maxCoeff()));
  }
  // Where a segment crosses a row, rounding can put it slightly outside the range of its ends'
  // columns.
  segments_.min_cell = {FloorToInt(low.x()) - 1, FloorToInt(low.y())};
  segments_.max_cell = {FloorToInt(high.x()) + 1, FloorToInt(high.y())};
}

}  // namespace depthgrid
