// Stamped camera poses, sorted by strictly increasing stamp.
#pragma once

#include <vector>

#include "mapper/core/pose3.h"

namespace depthgrid {

struct StampedPose {
  double stamp_s = 0.0;
  Pose3 world_from_camera;  // `world` stands for whatever frame the trajectory is in

  bool operator==(const StampedPose&) const = default;
};

using Trajectory = std::vector<StampedPose>;

}  // namespace depthgrid
