#include "eval/pictures/placed_path.h"

#include <algorithm>

#include "mapper/core/level.h"

namespace depthgrid {

Trajectory PlacedWhereItBegins(Trajectory slam, const Trajectory& estimate) {
  const auto first = std::find_first_of(
      slam.begin(), slam.end(), estimate.begin(), estimate.end(),
      [](const StampedPose& a, const StampedPose& b) { return a.stamp_s == b.stamp_s; });
  if (first == slam.end()) return slam;
  const auto there = std::find_if(estimate.begin(), estimate.end(), [&](const StampedPose& pose) {
    return pose.stamp_s == first->stamp_s;
  });
  const Pose2 map_from_slam =
      BaseOf(there->world_from_camera) * Inverse(BaseOf(first->world_from_camera));
  for (StampedPose& pose : slam) {
    pose.world_from_camera = ApplyPlanar(map_from_slam, pose.world_from_camera);
  }
  return slam;
}

}  // namespace depthgrid
