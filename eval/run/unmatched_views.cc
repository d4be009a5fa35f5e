#include "eval/run/unmatched_views.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

constexpr int kViewPointsAcross = 64;  // pixels of an image row that are looked at
// "Next to nothing": a tenth. Chosen.
constexpr double kNextToNothing = 0.1;
// Slope up to which a ray leads ahead at the camera's height: slice_half_height_m at 2 m.
constexpr double kAheadSlope = 0.05;

struct ViewCensus {
  int pixels = 0;
  int measured = 0, floor = 0, ceiling = 0;
  int ahead = 0, ahead_measured = 0, ahead_beyond = 0, ahead_below = 0;

  static bool IsMost(int part, int whole) {
    return whole > 0 && part >= (1.0 - kNextToNothing) * whole;
  }
};

ViewCensus CensusOf(const DepthImage& depth, const PinholeCamera& camera, const CameraStand& stand,
                    const ScanOptions& options) {
  ViewCensus census;
  const int step_px = std::max(1, depth.width_px / kViewPointsAcross);
  for (int v = step_px / 2; v < depth.height_px; v += step_px) {
    for (int u = step_px / 2; u < depth.width_px; u += step_px) {
      const Eigen::Vector3d ray = stand.level_from_camera * Unproject(camera, u, v, 1.0);
      const double z_m = depth.At(u, v);
      const bool measured = z_m > 0.0 && std::isfinite(z_m);
      const double height_m = stand.height_m + z_m * ray.z();
      const double range_m = z_m * ray.head<2>().norm();
      ++census.pixels;
      census.measured += measured ? 1 : 0;
      census.floor += measured && height_m < options.band_low_m ? 1 : 0;
      census.ceiling += measured && height_m > options.band_high_m ? 1 : 0;
      if (std::abs(ray.z()) > kAheadSlope * ray.head<2>().norm()) continue;
      ++census.ahead;
      census.ahead_measured += measured ? 1 : 0;
      census.ahead_beyond += measured && range_m > options.max_range_m ? 1 : 0;
      census.ahead_below += measured && range_m < options.min_range_m ? 1 : 0;
    }
  }
  return census;
}

// Which of the reasons takes most from what the image shows ahead.
ShownView MissingAhead(const ViewCensus& census) {
  const int no_depth = census.ahead - census.ahead_measured;
  if (no_depth >= std::max(census.ahead_beyond, census.ahead_below)) {
    return ShownView::kNoDepthAhead;
  }
  return census.ahead_beyond >= census.ahead_below ? ShownView::kBeyondRange
                                                   : ShownView::kBelowRange;
}

}  // namespace

ShownView ShownIn(const DepthImage& depth, const PinholeCamera& camera, const CameraStand& stand,
                  const ScanOptions& options) {
  const ViewCensus census = CensusOf(depth, camera, stand, options);
  const auto is_most = ViewCensus::IsMost;
  if (is_most(census.pixels - census.measured, census.pixels)) return ShownView::kNoDepth;
  const int within = census.ahead_measured - census.ahead_beyond - census.ahead_below;
  if (within < kFewBeams * census.ahead) return MissingAhead(census);
  if (is_most(census.floor, census.measured)) return ShownView::kFloor;
  if (is_most(census.ceiling, census.measured)) return ShownView::kCeiling;
  if (is_most(census.floor + census.ceiling, census.measured)) return ShownView::kFloorAndCeiling;
  return ShownView::kOther;
}

void UnmatchedViews::Add(const FrameReport& report, const DepthImage& depth,
                         const PinholeCamera& camera, const ScanOptions& options) {
  const bool counts = any_mapped_ && report.slam_from_camera && report.stand &&
                      !report.match.found && report.beams < kFewBeams * options.beams;
  any_mapped_ = any_mapped_ || report.inserted;
  if (!counts) return;
  ++frames_;
  OfView& view = views_[static_cast<std::size_t>(ShownIn(depth, camera, *report.stand, options))];
  if (view.frames++ == 0) view.first = report.index;
}

}  // namespace depthgrid
