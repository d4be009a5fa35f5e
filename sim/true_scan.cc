#include "sim/true_scan.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapper/core/level.h"
#include "sim/band_outline.h"

namespace depthgrid {
namespace {

TriangleMesh FencesOf(const TriangleMesh& mesh, const HeightBand& band) {
  return OutlineOf(mesh, band, StateMap()).fences;
}

}  // namespace

TrueScanner::TrueScanner(const TriangleMesh& mesh, double floor_z_m, const RayScene& rays,
                         const PinholeCamera& camera, const TrueScanOptions& options)
    : band_low_z_m_(floor_z_m + options.band_low_m),
      band_high_z_m_(floor_z_m + options.band_high_m),
      fences_(FencesOf(mesh, {band_low_z_m_, band_high_z_m_}), rays.isa()),
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

Scan TrueScanner::Obstacles(const Pose3& world_from_camera) const {
  const Eigen::Vector3d& at = world_from_camera.translation;
  const auto beam_of = [&](const ViewPyramid& view, const Eigen::Vector3d& direction,
                           double blocked_m) {
    Beam beam;
    const ValueSpan reach_m = {options_.min_range_m, std::min(blocked_m, options_.max_range_m)};
    if (reach_m.low > reach_m.high) return beam;
    const auto clear = view.Part({at.x(), at.y(), band_low_z_m_}, direction, reach_m);
    if (clear) {
      beam.clear_from_m = static_cast<float>(clear->low);
      beam.clear_to_m = static_cast<float>(clear->high);
    }
    const Eigen::Vector3d foot(at.x() + blocked_m * direction.x(),
                               at.y() + blocked_m * direction.y(), 0.0);
    beam.hit = blocked_m <= options_.max_range_m &&
               view.Part(foot, Eigen::Vector3d::UnitZ(), {band_low_z_m_, band_high_z_m_});
    if (beam.hit) beam.range_m = static_cast<float>(blocked_m);
    return beam;
  };
  return ScanOf(world_from_camera, fences_, kFenceMiddleM, beam_of);
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
