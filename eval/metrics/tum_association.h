// Which poses belong together by the rule of the TUM RGB-D benchmark's own scripts (associate.py,
// Sturm et al. 2012).
#pragma once

#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

// The scripts' default.
constexpr double kTumMaxStampDifferenceS = 0.02;

// Of all pairs of stamps nearer than the limit, the nearest first, each pose once; in the order of
// the reference's stamps. Of equally near ones the earlier reference goes first, then the earlier
// estimate.
std::vector<PosePair> AssociateAsTum(const Trajectory& reference, const Trajectory& estimate,
                                     double max_difference_s = kTumMaxStampDifferenceS);

}  // namespace depthgrid
