// Pairs the poses of two trajectories by the rule of the TUM RGB-D benchmark's scripts
// (associate.py, Sturm et al. 2012).
#pragma once

#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

// The scripts' default.
constexpr double kTumMaxStampDifferenceS = 0.02;

// Takes pairs with stamps nearer than the limit, nearest first, each pose once. On ties the earlier
// reference is taken first, then the earlier estimate. Returned in the order of the reference.
std::vector<PosePair> AssociateAsTum(const Trajectory& reference, const Trajectory& estimate,
                                     double max_difference_s = kTumMaxStampDifferenceS);

}  // namespace depthgrid
