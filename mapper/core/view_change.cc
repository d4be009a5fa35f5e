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

// A view that changed by less than this, and noise, for so long is that of a sensor that stands.
// Chosen: a fifth of what motion is of a log, half of that of live frames.
constexpr double kStillM = 0.01;
constexpr double kStandsS = 1.0;
// A share of what is seen that is farther than before was uncovered. Chosen: with 0.1 three people
// before a robot uncovered as much for 55 of 1,260 scans of one log (docs/tried.md, "Poses that
// stay").
constexpr double kUncoveredShare = 0.15;

bool IsThere(float z_m) { return std::isfinite(z_m) && z_m > 0.0F; }

}  // namespace

void StillView::Begin(double stamp_s) {
  *this = {};
  since_s_ = stamp_s;
}

void StillView::Add(double stamp_s, const std::vector<double>& since_first_m, double since_last_m,
                    double moved_m) {
  noise_m_ = std::max(noise_m_, since_last_m);
  still_ = still_ && MedianChangeM(since_first_m) < kStillM + noise_m_;
  stood_ = stood_ || (still_ && stamp_s - since_s_ >= kStandsS);
  const auto farther = std::count_if(since_first_m.begin(), since_first_m.end(),
                                     [&](double by_m) { return by_m > moved_m; });
  uncovered_ = uncovered_ || static_cast<double>(farther) >
                                 kUncoveredShare * static_cast<double>(since_first_m.size());
}

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

std::vector<double> ViewSample::DifferencesM(const ViewSample& other) const {
  std::vector<double> differences_m;
  if (width_px_ != other.width_px_ || height_px_ != other.height_px_) return differences_m;
  auto a = readings_.begin();
  auto b = other.readings_.begin();
  while (a != readings_.end() && b != other.readings_.end()) {
    if (a->bearing_rad < b->bearing_rad - kSameBearingRad) {
      ++a;
    } else if (b->bearing_rad < a->bearing_rad - kSameBearingRad) {
      ++b;
    } else {
      if (a->distance_m > 0.0F && b->distance_m > 0.0F) {
        differences_m.push_back(a->distance_m - b->distance_m);
      }
      ++a;
      ++b;
    }
  }
  return differences_m;
}

double MedianChangeM(std::vector<double> differences_m) {
  if (differences_m.size() < kFewReadings) return 0.0;
  for (double& difference_m : differences_m) difference_m = std::abs(difference_m);
  return UpperMedian(std::move(differences_m));
}

}  // namespace depthgrid
