// The events in a recorded run: jumps of the estimate and losses of tracking.
#pragma once

#include <vector>

#include "sim/slam/slam_run.h"

namespace depthgrid {

// The motion from pose `from` to pose `to` contains a jump or a gap.
struct RunEvent {
  std::size_t from = 0;
  std::size_t to = 0;
  double lost_s = 0.0;      // above 0: tracking was lost in between
  bool correction = false;  // it at least halved the error: SLAM corrected itself
  Pose3 error;              // of the whole motion
};

// A jump is a motion error of more than five times the median (eight sigma of normal errors) and of
// more than 1 mm. Jumps less than 0.2 s apart are merged, as the estimate oscillates before it
// settles.
std::vector<RunEvent> FindEvents(const SlamRun& run);

// The parts of the run between its corrections.
std::vector<SlamRun> BetweenCorrections(const SlamRun& run);

}  // namespace depthgrid
