// What is known of how groups of frames lie to each other, from the frames between.
#pragma once

#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/surfel/joint_adjustment.h"
#include "mapper/surfel/surfel_groups.h"

namespace depthgrid {

// SLAM's motion from each group to the next, from those of the frames between. Where frames between
// moved with earlier groups, the tie to the one that the frame before is in.
std::vector<GroupMotion> MotionsOf(const SurfelGroups& of, const std::vector<MappedFrame>& frames);

// How far groups that were not joined yet may be.
std::vector<GroupStart> StartsOf(const SurfelGroups& of, const std::vector<MappedFrame>& frames);

// How many groups such an adjustment takes.
GroupLimits LimitsFor(AdjustEffort effort, const JointOptions& joint,
                      const std::vector<GroupStart>& starts);

// The position of the first frame that is not a prior map's.
int FirstNew(const std::vector<MappedFrame>& frames);

}  // namespace depthgrid
