// The last step of the joint adjustment: each frame's pose from its own scan and the prior's motion
// (docs/math.md, "Joint adjustment").
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mapper/frame_report.h"

namespace depthgrid {

struct SmootherFrame {
  Pose2 map_from_base;          // a good guess
  MatchResult match;            // against the adjusted map; not found: the motion alone
  std::optional<Pose2> motion;  // the prior's, from the frame before
};

// The most likely poses given all matches and motions; `motion_sigma` (forward m, left m, yaw rad)
// is that of the motion of one frame. Frames without motion hang on their match, frames with
// neither stay.
std::vector<Pose2> Smoothed(const std::vector<SmootherFrame>& frames,
                            const Eigen::Vector3d& motion_sigma);

}  // namespace depthgrid
