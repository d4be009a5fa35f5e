// Detects a pose that SLAM or odometry gives again and again, bit for bit, while the sensor moves:
// a tracker that is lost, an encoder that was unplugged. Frame by frame; of a recording, whose next
// poses are known, mapper/io/held_frames.h tells more.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "mapper/core/frame.h"
#include "mapper/core/slam_step.h"
#include "mapper/core/view_change.h"

namespace depthgrid {

class HeldWatch {
 public:
  // Whether the frame's pose is held: it has been the same for more than twice as many frames as is
  // usual, and what the frame shows has changed since the first of them by more than 2 cm and 1.5
  // times the largest change from one of them to the next, which is noise and motion; until it has
  // changed by less than half of that again. Never before the first pose that differs, as there may
  // be no odometry, nor where the sensor stood for a second since that pose came and what changed
  // is nearer only (StillView): people who come. Who comes within that second looks like motion,
  // and a drive straight at a wall like people. Call once per frame, in order of time.
  bool IsHeld(const Frame& frame);
  // After IsHeld(): the last frame's pose if it repeats the one before because poses come at half
  // the frames' rate or less: moved on by the motion between the last two poses, for as long as
  // that took. Empty where the pose is to be taken as it is.
  std::optional<Pose3> MovedOn() const;
  // Frame::index of the first frame with this pose.
  int first_frame() const { return first_frame_; }

 private:
  void Begin(const Frame& frame);
  std::size_t UsualRun() const;
  std::size_t UsualRunSoFar() const;

  std::optional<Pose3> pose_;
  double since_s_ = 0.0;  // stamp of the first frame with this pose
  double now_s_ = 0.0;    // and of the last one
  int slam_epoch_ = 0;
  std::optional<SlamStep> step_;  // from the pose before to this, unless SLAM jumped
  bool repeats_ = false;          // the last frame has this pose, and is not its first
  int first_frame_ = -1;
  std::size_t run_ = 0;  // frames with this pose
  bool held_ = false;
  StillView still_;
  double largest_step_m_ = 0.0;  // ViewSample::ChangeFromM() between successive ones of these
  bool moves_ = false;           // a different pose occurred before
  // How many frames had the last poses: more than one where poses are read more often than made.
  std::array<std::size_t, 8> runs_ = {1, 1, 1, 1, 1, 1, 1, 1};
  std::size_t poses_ = 0;
  ViewSample first_, last_, now_;
};

}  // namespace depthgrid
