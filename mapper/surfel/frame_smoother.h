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
  MatchResult match;            // against the adjusted map; not found: the motion alone
  std::optional<Pose2> motion;  // the prior's, from the frame before
  bool stands = false;          // it stood still
};

// How the prior's motion errs, as the matches tell.
MotionNoise NoiseOf(const std::vector<SmootherFrame>& frames);

// The most likely poses given all matches and motions. The prior's bias of each frame is unknown
// too, and its jitter is told from the camera's own motion. Each pose stays near its guess, to
// `stay_m` and a tenth of a radian for each metre of that (standard deviations; 0: anywhere): a
// bias that is told before and after a stretch of a thousand frames says little of where they go
// between.
std::vector<Pose2> Smoothed(const std::vector<SmootherFrame>& frames, const MotionNoise& noise,
                            double stay_m);

}  // namespace depthgrid
