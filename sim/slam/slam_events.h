// The events in a recorded run: where the estimate jumped, and whether it was lost before.
#pragma once

#include <vector>

#include "sim/slam/slam_run.h"

namespace depthgrid {

// The motion from pose `from` to pose `to` is a jump, or a gap.
struct RunEvent {
  std::size_t from = 0;
  std::size_t to = 0;
  double lost_s = 0.0;      // above 0: tracking was lost in between
  bool correction = false;  // it halved the error or better: SLAM corrected itself
  Pose3 error;              // of the whole motion
};

// A jump is a motion error more than five medians long (eight sigma of normal errors); jumps less
// than 0.2 s apart are one, as the estimate swings before it settles.
std::vector<RunEvent> FindEvents(const SlamRun& run);

// The stretches of the run that no correction lies in.
std::vector<SlamRun> BetweenCorrections(const SlamRun& run);

}  // namespace depthgrid
