#include "mapper/core/view_change.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/median.h"

namespace depthgrid {
namespace {

constexpr int kGridColumns = 40, kGridRows = 30;
// Bearings of the same beam in two scans differ by rounding only.
constexpr float kSameBearingRad = 1e-4F;

bool IsThere(float z_m) { return std::isfinite(z_m) && z_m > 0.0F; }

}  // namespace

void ViewSample::Take(const DepthImage& depth) {
  readings_.clear();
  width_px_ = depth.width_px;
  height_px_ = depth.height_px;
  const int step_x = std::max(width_px_ / kGridColumns, 1);
  const int step_y = std::max(height_px_ / kGridRows, 1);
  for (int v = step_y / 2; v < height_px_; v += step_y) {
    for (int u = step_x / 2; u < width_px_; u += step_x) {
      const float z_m = depth.Row(v)[u];
      readings_.push_back({0.0F, IsThere(z_m) ? z_m : 0.0F});
    }
  }
}

void ViewSample::Take(const Scan& scan) {
  readings_.clear();
  width_px_ = height_px_ = 0;
  for (const Beam& beam : scan.beams) {
    if (beam.hit && std::isfinite(beam.bearing_rad) && IsThere(beam.range_m)) {
      readings_.push_back({beam.bearing_rad, beam.range_m});
    }
  }
  const auto before = [](const Reading& a, const Reading& b) {
    return a.bearing_rad < b.bearing_rad;
  };
  if (!std::is_sorted(readings_.begin(), readings_.end(), before)) {
    std::stable_sort(readings_.begin(), readings_.end(), before);
  }
}

double ViewSample::ChangeFromM(const ViewSample& other) const {
  if (width_px_ != other.width_px_ || height_px_ != other.height_px_) return 0.0;
  std::vector<double> changes_m;
  auto a = readings_.begin();
  auto b = other.readings_.begin();
  while (a != readings_.end() && b != other.readings_.end()) {
    if (a->bearing_rad < b->bearing_rad - kSameBearingRad) {
      ++a;
    } else if (b->bearing_rad < a->bearing_rad - kSameBearingRad) {
      ++b;
    } else {
      if (a->distance_m > 0.0F && b->distance_m > 0.0F) {
        changes_m.push_back(std::abs(a->distance_m - b->distance_m));
      }
      ++a;
      ++b;
    }
  }
  return changes_m.size() < kFewReadings ? 0.0 : UpperMedian(std::move(changes_m));
}

}  // namespace depthgrid
