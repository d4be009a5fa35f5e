// Whether the map's motions are throughout longer or shorter than SLAM's by one factor, as with a
// depth scale that is slightly wrong.
#pragma once

#include <optional>

#include "eval/doubts/way_check.h"
#include "eval/run/mapping_run.h"

namespace depthgrid {

struct ScaleFault {
  Ways ways;
  double ratio = 1.0;  // of the map's motions to SLAM's
  double sigma = 0.0;  // standard deviation of its logarithm
};

// The factor, if it differs from 1 by more than 4 %, however noisy either is, and by more than five
// standard deviations, and if it explains 92 % or more of what the motions differ by (as a sum of
// squares). Of SLAM's drift, which makes a path too long here and too short there, one factor
// explains less. Empty for fewer than 12 stretches of half a metre.
std::optional<ScaleFault> SlightScaleDoubt(const MappingRun& run);

}  // namespace depthgrid
