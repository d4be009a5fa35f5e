#include "eval/metrics/association.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// The pose whose stamp is nearest, the earlier one on ties; `poses` is sorted and not empty.
const StampedPose& Nearest(const Trajectory& poses, double stamp_s) {
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), stamp_s,
                       [](const StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
  if (after == poses.begin()) return *after;
  const auto before = std::prev(after);
  if (after == poses.end()) return *before;
  return std::abs(before->stamp_s - stamp_s) <= std::abs(after->stamp_s - stamp_s) ? *before
                                                                                   : *after;
}

}  // namespace

PosePair PairOf(StampedPose reference, StampedPose estimate) {
  reference.world_from_camera.rotation.normalize();
  estimate.world_from_camera.rotation.normalize();
  return {reference, estimate};
}

std::vector<PosePair> Associate(const Trajectory& reference, const Trajectory& estimate,
                                double max_difference_s) {
  std::vector<PosePair> pairs;
  if (reference.empty() || estimate.empty()) return pairs;
  const bool reference_is_longer = reference.size() >= estimate.size();
  const Trajectory& shorter = reference_is_longer ? estimate : reference;
  const Trajectory& longer = reference_is_longer ? reference : estimate;
  for (const StampedPose& pose : shorter) {
    const StampedPose& nearest = Nearest(longer, pose.stamp_s);
    if (!(std::abs(nearest.stamp_s - pose.stamp_s) <= max_difference_s)) continue;
    pairs.push_back(reference_is_longer ? PairOf(nearest, pose) : PairOf(pose, nearest));
  }
  return pairs;
}

}  // namespace depthgrid
