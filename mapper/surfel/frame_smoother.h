// The last step of the joint adjustment: each frame's pose from its own scan and the prior's motion
// (docs/math.md, "Joint adjustment").
#pragma once

#include <optional>
#include <vector>

#include "mapper/frame_report.h"
#include "mapper/fuse/motion_noise.h"

namespace depthgrid {

struct SmootherFrame {
  Pose2 map_from_base;          // a good guess
  MatchResult match;            // against the adjusted map; not found: the motion alone
  std::optional<Pose2> motion;  // the prior's, from the frame before
};

// How the prior's motion errs, as the matches tell.
MotionNoise NoiseOf(const std::vector<SmootherFrame>& frames);

// The most likely poses given all matches and motions. The prior's bias of each frame is unknown
// too, and its jitter is told from the camera's own motion.
std::vector<Pose2> Smoothed(const std::vector<SmootherFrame>& frames, const MotionNoise& noise);

}  // namespace depthgrid
