#include "eval/doubts/storey_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "mapper/core/counted.h"
#include "sim/mesh/floor.h"

namespace depthgrid {
namespace {

constexpr double kLeastStoreyM = 1.5;  // headroom, as under a ceiling (sim/mesh/floor.cc)
constexpr double kLevelM = 0.05;       // heights within this count as one, as for floors

// Heights of the surface straight below each pose, ascending; poses above nothing are left out.
std::vector<double> HeightsBelow(const Trajectory& trajectory, const RayScene& rays) {
  std::vector<double> heights_m;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3f at_m = pose.world_from_camera.translation.cast<float>();
    const auto hit = rays.NearestHit({.origin = at_m, .direction = -Eigen::Vector3f::UnitZ()});
    if (hit) heights_m.push_back(static_cast<double>(at_m.z() - hit->distance));
  }
  std::sort(heights_m.begin(), heights_m.end());
  return heights_m;
}

// The largest set of sorted heights within kLevelM.
std::span<const double> MostAlike(const std::vector<double>& heights_m) {
  std::span<const double> most;
  std::size_t end = 0;
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    while (end < heights_m.size() && heights_m[end] <= heights_m[i] + kLevelM) ++end;
    if (end - i > most.size()) most = std::span(heights_m).subspan(i, end - i);
  }
  return most;
}

std::size_t CountBelow(const Trajectory& trajectory, double z_m) {
  return static_cast<std::size_t>(std::count_if(
      trajectory.begin(), trajectory.end(),
      [&](const StampedPose& pose) { return pose.world_from_camera.translation.z() < z_m; }));
}

// Rounds off errors of the single-precision mesh; + 0.0 makes -0 positive.
double InMillimetres(double z_m) { return std::round(1000.0 * z_m) / 1000.0 + 0.0; }

// Of a path most of which is below the floor, above the surface at `level_z_m` if there is one.
std::string BelowText(std::size_t below, std::size_t poses, const Scene& scene,
                      const std::optional<double>& level_z_m) {
  const std::string what =
      fmt::format("{} of {} are below the floor of the maps, z = {:g} m", below,
                  Counted(poses, "pose"), InMillimetres(scene.floor_z_m));
  if (!level_z_m || !HasFloorAt(scene.mesh, *level_z_m)) {
    return what + "; floor_z_m in the scene's file must be that of the path's storey";
  }
  return fmt::format("{}; floor_z_m: {:g} in the scene's file takes the storey that they are in",
                     what, *level_z_m);
}

}  // namespace

std::optional<std::string> DoubtOfStorey(const Trajectory& trajectory, const Scene& scene,
                                         const RayScene& rays) {
  const std::vector<double> heights_m = HeightsBelow(trajectory, rays);
  const std::span<const double> level_m = MostAlike(heights_m);
  const bool has_level = 2 * level_m.size() > trajectory.size();
  const double z_m = has_level ? InMillimetres(level_m[level_m.size() / 2]) : 0.0;
  const std::size_t below = CountBelow(trajectory, scene.floor_z_m);
  if (2 * below > trajectory.size()) {
    return BelowText(below, trajectory.size(), scene,
                     has_level ? std::optional(z_m) : std::nullopt);
  }
  if (!has_level) return {};
  if (z_m < scene.floor_z_m + kLeastStoreyM || !HasFloorAt(scene.mesh, z_m)) return {};
  return fmt::format(
      "{} of {} are above a level surface at z = {:g} m, but maps are of the storey whose floor is "
      "at {:g} m; floor_z_m: {:g} in the scene's file takes the upper one",
      level_m.size(), Counted(trajectory.size(), "pose"), z_m, InMillimetres(scene.floor_z_m), z_m);
}

}  // namespace depthgrid
