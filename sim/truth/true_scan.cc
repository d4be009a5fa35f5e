#include "sim/truth/true_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "mapper/core/level.h"
#include "sim/truth/band_outline.h"
#include "sim/truth/truth_grid.h"

namespace depthgrid {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();
// Step past a surface that was hit, or into view of one hit along the image's edge; larger than
// rounding errors.
constexpr double kBeyondM = 1e-3;

}  // namespace

struct TrueScanner::Surfaces {
  Surfaces(const TriangleMesh& mesh, double floor_z_m, const TruthGridOptions& grid, RayIsa isa)
      : cells(SurfaceCells(mesh, floor_z_m, grid)),
        outline(
            OutlineOf(mesh, {floor_z_m + grid.band_low_m, floor_z_m + grid.band_high_m}, cells)),
        fences(outline.fences, isa) {}

  StateMap cells;
  BandOutline outline;
  RayScene fences;
};

TrueScanner::TrueScanner(const TriangleMesh& mesh, double floor_z_m, const RayScene& rays,
                         const PinholeCamera& camera, const TrueScanOptions& options)
    : band_low_z_m_(floor_z_m + options.band_low_m),
      band_high_z_m_(floor_z_m + options.band_high_m),
      surfaces_(std::make_shared<const Surfaces>(
          mesh, floor_z_m,
          TruthGridOptions{options.resolution_m, options.band_low_m, options.band_high_m},
          rays.isa())),
      rays_(rays),
      camera_(camera),
      options_(options) {}

template <typename BeamOf>
Scan TrueScanner::ScanOf(const Pose3& world_from_camera, const RayScene& rays, float height_m,
                         BeamOf beam_of) const {
  const ViewPyramid view(camera_, world_from_camera, {options_.min_depth_m, options_.max_depth_m});
  const double yaw_rad = BaseOf(world_from_camera).yaw_rad;
  const ValueSpan bearings = view.Bearings(yaw_rad);
  const Eigen::Vector3d& at = world_from_camera.translation;
  const Eigen::Vector3f origin(static_cast<float>(at.x()), static_cast<float>(at.y()), height_m);
  std::vector<Ray> towards;
  std::vector<double> angles_rad;
  for (int b = 0; b < options_.beams; ++b) {
    const double part = (b + 0.5) / options_.beams;
    angles_rad.push_back(bearings.low + part * (bearings.high - bearings.low));
    const Eigen::Vector3d direction(std::cos(angles_rad.back()), std::sin(angles_rad.back()), 0.0);
    towards.push_back({origin, direction.cast<float>(), static_cast<float>(options_.max_range_m)});
  }
  std::vector<float> ranges_m(towards.size());
  rays.NearestHits(towards, ranges_m);
  Scan scan;
  scan.max_range_m = options_.max_range_m;
  for (std::size_t b = 0; b < towards.size(); ++b) {
    Beam beam = beam_of(view, towards[b].direction.cast<double>(), ranges_m[b]);
    beam.bearing_rad = static_cast<float>(WrapAngle(angles_rad[b] - yaw_rad));
    scan.beams.push_back(beam);
  }
  return scan;
}

bool TrueScanner::IsSeen(const ViewPyramid& view, const Eigen::Vector2d& end) const {
  const auto cell = OccupiedCellAt(surfaces_->cells, end);
  return cell && view.Part({end.x(), end.y(), 0.0}, Eigen::Vector3d::UnitZ(),
                           surfaces_->outline.height_m[*cell]);
}

double TrueScanner::NextOutline(const Eigen::Vector3d& at, const Eigen::Vector3d& direction,
                                double from_m) const {
  const double start_m = from_m + kBeyondM;
  Eigen::Vector3d origin = at + start_m * direction;
  origin.z() = kFenceMiddleM;
  const auto hit = surfaces_->fences.NearestHit({origin.cast<float>(), direction.cast<float>()});
  return hit ? start_m + hit->distance : kNowhere;
}

// The nearest hit along the image's lower and upper edge: a horizontal surface, such as a box's
// top, comes into view there.
double TrueScanner::NearestOnEdges(const ViewPyramid& image, const Eigen::Vector3d& at,
                                   const Eigen::Vector3d& direction) const {
  constexpr double kSteepest = 1e3;
  double nearest_m = kNowhere;
  const auto slopes = image.Part(at + direction, Eigen::Vector3d::UnitZ(), {-kSteepest, kSteepest});
  if (!slopes) return nearest_m;
  for (const double slope : {slopes->low, slopes->high}) {
    const Eigen::Vector3d along = direction + slope * Eigen::Vector3d::UnitZ();
    const auto hit = rays_.NearestHit({at.cast<float>(), along.cast<float>()});
    if (!hit) continue;
    const double z_m = at.z() + slope * hit->distance;
    if (z_m < band_low_z_m_ || z_m > band_high_z_m_) continue;
    nearest_m = std::min(nearest_m, hit->distance + kBeyondM);
  }
  return nearest_m;
}

// `low_line` is the interval in which the band's lower edge is in view.
TrueScanner::Sight TrueScanner::Look(const ViewPyramid& image, const Eigen::Vector3d& at,
                                     const Eigen::Vector3d& direction, double outline_m,
                                     const std::optional<ValueSpan>& low_line) const {
  Sight sight{outline_m, options_.max_range_m};
  const auto is_passed = [&] {
    return sight.seen_m <= options_.max_range_m &&
           !IsSeen(image, (at + sight.seen_m * direction).head<2>());
  };
  if (!is_passed()) return sight;
  while (is_passed()) {
    // Out of view although the band's lower edge is in view, so it is above the image: an obstacle
    // all the same.
    if (low_line && sight.seen_m >= low_line->low) {
      sight.free_until_m = std::min(sight.free_until_m, sight.seen_m);
    }
    sight.seen_m = NextOutline(at, direction, sight.seen_m);
  }
  sight.seen_m = std::min(sight.seen_m, NearestOnEdges(image, at, direction));
  return sight;
}

Scan TrueScanner::Obstacles(const Pose3& world_from_camera) const {
  const Eigen::Vector3d& at = world_from_camera.translation;
  const ViewPyramid image(camera_, world_from_camera, {0.0, kNowhere});
  const auto beam_of = [&](const ViewPyramid& view, const Eigen::Vector3d& direction,
                           double outline_m) {
    const Eigen::Vector3d foot(at.x(), at.y(), band_low_z_m_);
    const ValueSpan range_m = {options_.min_range_m, options_.max_range_m};
    const Sight sight = Look(image, at, direction, outline_m, view.Part(foot, direction, range_m));
    const ValueSpan reach_m = {range_m.low, std::min(sight.seen_m, sight.free_until_m)};
    Beam beam;
    if (sight.seen_m < range_m.low) return beam;
    const auto clear = view.Part(foot, direction, reach_m);
    if (clear) {
      beam.clear_from_m = static_cast<float>(clear->low);
      beam.clear_to_m = static_cast<float>(clear->high);
    }
    // A visible obstacle at a depth that the sensor cannot measure gives no hit, nor does anything
    // behind it.
    beam.hit =
        sight.seen_m <= range_m.high && IsSeen(view, (at + sight.seen_m * direction).head<2>());
    if (beam.hit) beam.range_m = static_cast<float>(sight.seen_m);
    return beam;
  };
  return ScanOf(world_from_camera, surfaces_->fences, kFenceMiddleM, beam_of);
}

Scan TrueScanner::Slice(const Pose3& world_from_camera) const {
  const Eigen::Vector3d& at = world_from_camera.translation;
  const auto beam_of = [&](const ViewPyramid& view, const Eigen::Vector3d& direction,
                           double blocked_m) {
    Beam beam;
    const ValueSpan reach_m = {options_.min_range_m, std::min(blocked_m, options_.max_range_m)};
    if (reach_m.low > reach_m.high) return beam;
    const auto seen = view.Part(at, direction, reach_m);
    if (!seen) return beam;
    beam.clear_from_m = static_cast<float>(seen->low);
    beam.clear_to_m = static_cast<float>(seen->high);
    beam.hit = blocked_m <= options_.max_range_m && seen->high >= reach_m.high;
    if (beam.hit) beam.range_m = static_cast<float>(blocked_m);
    return beam;
  };
  return ScanOf(world_from_camera, rays_, static_cast<float>(at.z()), beam_of);
}

}  // namespace depthgrid
