// Stamped camera poses, sorted by strictly increasing stamp.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/core/pose3.h"

namespace depthgrid {

struct StampedPose {
  double stamp_s = 0.0;
  Pose3 world_from_camera;  // `world` stands for whatever frame the trajectory is in

  bool operator==(const StampedPose&) const = default;
};

using Trajectory = std::vector<StampedPose>;

std::vector<double> StampsOf(const Trajectory& trajectory);

// Index of the entry whose stamp is nearest (the first on ties) and at most `max_difference_s`
// away. `stamps_s` is sorted.
std::optional<std::size_t> NearestStamp(const std::vector<double>& stamps_s, double stamp_s,
                                        double max_difference_s);

}  // namespace depthgrid
