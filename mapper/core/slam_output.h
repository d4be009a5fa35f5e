// Output of an RGB-D SLAM system for a sequence: the live pose of each frame, loop closures, and
// its own final trajectory.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/trajectory.h"

namespace depthgrid {

// SLAM recognised that frame `second` sees what frame `first` saw. The measured relative pose
// carries one standard deviation for translation and one for rotation (isotropic information
// 1/sigma^2).
struct LoopClosure {
  // The event arrives with this frame, before its pose; >= max(first_frame, second_frame). Only
  // used in files: the mapper gets a loop with the frame that carries it (Frame::loops).
  int reported_at_frame = 0;
  int first_frame = 0;
  int second_frame = 0;
  Pose3 first_from_second;  // relative camera pose
  double sigma_translation_m = 0.02;
  double sigma_rotation_rad = 0.01;

  bool operator==(const LoopClosure&) const = default;
};

// The pose of one frame as SLAM gave it live. The epoch counts SLAM's corrections of itself (loop
// closed, relocalised): the difference of two poses is a motion only when their epochs agree.
struct SlamPose {
  double stamp_s = 0.0;
  std::optional<Pose3> slam_from_camera;  // empty while tracking is lost
  int epoch = 0;

  bool operator==(const SlamPose&) const = default;
};

struct SlamOutput {
  std::vector<SlamPose> live;      // one an input frame
  Trajectory final;                // after all corrections; frames SLAM never placed are absent
  std::vector<LoopClosure> loops;  // ordered by reported_at_frame
  // Whether the warnings of whoever read it say already how many frames have no pose.
  bool lack_is_told = false;
};

}  // namespace depthgrid
