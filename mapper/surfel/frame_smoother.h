// The last step of the joint adjustment: each frame's pose from its own scan and the prior's motion
// (docs/math.md, "The last smoothing").
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/frame_report.h"
#include "mapper/fuse/motion_noise.h"

namespace depthgrid {

struct SmootherFrame {
  Pose2 map_from_base;          // a good guess
  MatchResult match;            // against the adjusted map; if not found, only the motion is used
  std::optional<Pose2> motion;  // SLAM's, from the previous frame
  bool stands = false;          // SLAM's pose stood still
  // SLAM's walk and bias here as a multiple of those elsewhere.
  Eigen::Vector3d growth = Eigen::Vector3d::Ones();
};

// The noise of SLAM's motion, estimated from the matches.
MotionNoise NoiseOf(const std::vector<SmootherFrame>& frames);

// The maximum a posteriori poses given all matches and motions. SLAM's bias in each frame is an
// unknown as well, and its jitter is separated from the camera's motion. Each pose is held near its
// guess with standard deviations `stay_m` and 0.1 rad/m * stay_m (0: not held): a bias known before
// and after a stretch of a thousand frames hardly constrains the poses in between.
std::vector<Pose2> Smoothed(const std::vector<SmootherFrame>& frames, const MotionNoise& noise,
                            double stay_m);

}  // namespace depthgrid
