#include "eval/metrics/association.h"

namespace depthgrid {

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
  const std::vector<double> stamps_s = StampsOf(longer);
  for (const StampedPose& pose : shorter) {
    const auto nearest = NearestStamp(stamps_s, pose.stamp_s, max_difference_s);
    if (!nearest) continue;
    pairs.push_back(reference_is_longer ? PairOf(longer[*nearest], pose)
                                        : PairOf(pose, longer[*nearest]));
  }
  return pairs;
}

}  // namespace depthgrid
