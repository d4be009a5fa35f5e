#include "mapper/surfel/wall_ranges.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/grid_geometry.h"
#include "mapper/surfel/surfel_map.h"

namespace depthgrid {
namespace {

// Scans that the noise is learnt from.
constexpr std::size_t kScansOfNoise = 300;
// A wall returns a beam that meets it this near to one of its surfels, which lie .03 to .06 m
// apart.
constexpr double kBesideM = 0.06;
// Walls met at a more grazing angle than 84 degrees return nothing.
constexpr double kLeastCosine = 0.1;

}  // namespace

LaserNoise::LaserNoise(const std::vector<MappedFrame>& frames) {
  const std::size_t step = frames.size() / kScansOfNoise + 1;
  for (std::size_t i = 0; i < frames.size(); i += step) {
    if (!DrawsWhatItMatches(frames[i])) continue;
    const Scan scan = *frames[i].scan;
    noise_.Add(scan);
    for (const Beam& beam : scan.beams) {
      if (beam.hit) farthest_m_ = std::max(farthest_m_, double{beam.range_m});
    }
  }
}

bool DrawsWhatItMatches(const MappedFrame& frame) {
  if (!frame.kept() || !frame.scan || !frame.obstacles) return false;
  if (frame.scan == frame.obstacles) return true;
  const Scan matched = *frame.scan, drawn = *frame.obstacles;
  if (matched.beams.size() != drawn.beams.size()) return false;
  bool any = false;
  for (std::size_t i = 0; i < drawn.beams.size(); ++i) {
    if (!matched.beams[i].hit || !drawn.beams[i].hit) continue;
    if (matched.beams[i].range_m != drawn.beams[i].range_m) return false;
    any = true;
  }
  return any;
}

WallRanges::WallRanges(const std::vector<MappedFrame>& frames, const LaserNoise& noise,
                       double least_sigma_m, double most_sigmas)
    : noise_(noise), least_sigma_m_(least_sigma_m), most_sigmas_(most_sigmas) {
  SurfelMap map{SurfelOptions{}};
  for (const MappedFrame& frame : frames) {
    if (DrawsWhatItMatches(frame)) map.InsertCut(map.Cut(*frame.scan), frame.map_from_base);
  }
  for (const Surfel& surfel : map.surfels().surfels()) Add(surfel);
}

std::uint64_t WallRanges::KeyOf(const Eigen::Vector2d& place_m) {
  const Cell cell = CellOf(place_m, kCellM);
  return (std::uint64_t{static_cast<std::uint32_t>(cell.y)} << 32U) |
         static_cast<std::uint32_t>(cell.x);
}

void WallRanges::Add(const Surfel& surfel) {
  const std::uint64_t key = KeyOf(surfel.point_m);
  int cell = cell_of_key_.Find(key);
  if (cell < 0) {
    cell = static_cast<int>(cells_.size());
    cell_of_key_.Add(key, cell);
    cells_.emplace_back();
  }
  cells_[static_cast<std::size_t>(cell)].push_back(surfel);
}

double WallRanges::RangeOnWall(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction,
                               double range_m) const {
  const double sigma_m = noise_.SigmaM(range_m);
  const double reach_m = most_sigmas_ * sigma_m;
  double best = 0.0, best_m = range_m;
  // What a wall was seen by tells how likely it is to be seen again.
  const auto weigh = [&](const Surfel& surfel) {
    const double cosine = -surfel.normal.dot(direction);
    if (cosine < kLeastCosine) return;
    const double met_m = OffsetFrom(surfel, origin_m) / cosine;
    const double off_m = met_m - range_m;
    if (std::abs(off_m) > reach_m) return;
    if ((origin_m + met_m * direction - surfel.point_m).squaredNorm() > kBesideM * kBesideM) return;
    const double weight = surfel.information * std::exp(-0.5 * off_m * off_m / (sigma_m * sigma_m));
    if (weight <= best) return;
    best = weight;
    best_m = met_m;
  };
  // No surfel beside the beam is missed: those of a place lie in its cell and the eight around it.
  const int steps = static_cast<int>(std::ceil(2.0 * reach_m / kCellM));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d place_m = origin_m + (range_m - reach_m + i * kCellM) * direction;
    for (const double y : {-kCellM, 0.0, kCellM}) {
      for (const double x : {-kCellM, 0.0, kCellM}) {
        const int cell = cell_of_key_.Find(KeyOf(place_m + Eigen::Vector2d(x, y)));
        if (cell < 0) continue;
        for (const Surfel& surfel : cells_[static_cast<std::size_t>(cell)]) weigh(surfel);
      }
    }
  }
  return best_m;
}

Scan WallRanges::Sharpened(const Scan& scan, const Pose2& map_from_base) const {
  const Motion2 motion(map_from_base);
  Scan sharp = scan;
  for (Beam& beam : sharp.beams) {
    if (!beam.hit || !(noise_.SigmaM(beam.range_m) > least_sigma_m_)) continue;
    const Eigen::Vector2d direction =
        motion.Turn({std::cos(beam.bearing_rad), std::sin(beam.bearing_rad)});
    const auto range_m =
        static_cast<float>(RangeOnWall(motion.shift_m, direction, double{beam.range_m}));
    // What was not clear up to the hit stays as it was.
    const bool clear = beam.clear_to_m == beam.range_m;
    beam.range_m = range_m;
    beam.clear_to_m = clear ? range_m : std::min(beam.clear_to_m, range_m);
  }
  return sharp;
}

}  // namespace depthgrid
