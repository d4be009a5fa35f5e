// Fits the surrogate's settings to the errors of a real system, given its trajectories and the true
// ones (docs/slam_surrogate.md, "Fit").
#pragma once

#include <string>
#include <vector>

#include "sim/slam/slam_options.h"
#include "sim/slam/slam_run.h"

namespace depthgrid {

struct SlamFit {
  SlamOptions options;          // profile and loops keep their defaults
  double tracked_s = 0.0;       // tracked time, to which the rates refer
  double pivot_explains = 0.0;  // explained share of the squared sideways error of motions
  int jumps = 0;
  int lost_bursts = 0;
  int corrections = 0;  // events in which SLAM corrects itself, left out of the fit
};

// Throws InputError, with `place`, when there are fewer than 100 poses.
SlamFit FitSlamErrors(const std::vector<SlamRun>& runs, const std::string& place = "");

}  // namespace depthgrid
