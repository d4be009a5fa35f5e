#include "eval/way_check.h"

#include <algorithm>

namespace depthgrid {
namespace {

// Poses err by centimetres from frame to frame, which does not add up over such stretches.
constexpr double kStretchM = 0.5;
// Of 36 runs of 450 frames in two shipped rooms, six profiles of SLAM with three seeds, it was 0.87
// to 1.10, but for one whose map had broken (0.77); depth read at a fifth of its scale gave 0.24.
constexpr double kMostRatio = 1.3;
constexpr double kLeastWayM = 2.0;

Eigen::Vector2d PlaceOf(const Pose3& pose) { return pose.translation.head<2>(); }

}  // namespace

Ways WaysOf(const MappingRun& run) {
  Ways ways;
  std::optional<std::size_t> begin;  // of the stretch
  for (std::size_t i = 0; i < run.reports.size(); ++i) {
    const auto& slam = run.reports[i].slam_from_camera;
    const auto& map = run.result.map_from_camera[i];
    if (!slam || !map || (begin && run.reports[*begin].slam_epoch != run.reports[i].slam_epoch)) {
      begin.reset();
    }
    if (!slam || !map) continue;
    if (!begin) begin = i;
    const double slam_m = (PlaceOf(*slam) - PlaceOf(*run.reports[*begin].slam_from_camera)).norm();
    const double map_m = (PlaceOf(*map) - PlaceOf(*run.result.map_from_camera[*begin])).norm();
    if (std::max(slam_m, map_m) < kStretchM) continue;
    ways.slam_m += slam_m;
    ways.map_m += map_m;
    begin = i;
  }
  return ways;
}

std::optional<Ways> ScaleDoubt(const MappingRun& run) {
  const Ways ways = WaysOf(run);
  const auto [least_m, most_m] = std::minmax(ways.slam_m, ways.map_m);
  if (most_m < kLeastWayM || most_m < kMostRatio * least_m) return {};
  return ways;
}

}  // namespace depthgrid
