// The surrogate's settings that describe a real system's errors, from its trajectories and the true
// ones (docs/slam_surrogate.md, "Fit").
#pragma once

#include <string>
#include <vector>

#include "sim/slam/slam_options.h"
#include "sim/slam/slam_run.h"

namespace depthgrid {

struct SlamFit {
  SlamOptions options;          // profile and loops keep their defaults
  double tracked_s = 0.0;       // what the rates are counted over
  double pivot_explains = 0.0;  // share of the squared sideways error of single motions
  int jumps = 0;
  int lost_bursts = 0;
  int corrections = 0;  // events that bring the estimate back: SLAM's own, and left out of the fit
};

// Throws InputError when there are fewer than 100 poses. `place`: where they came from, for that.
SlamFit FitSlamErrors(const std::vector<SlamRun>& runs, const std::string& place = "");

}  // namespace depthgrid
