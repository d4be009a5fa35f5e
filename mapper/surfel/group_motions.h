// Relative motions of groups, from the frames between them.
#pragma once

#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/surfel/joint_adjustment.h"
#include "mapper/surfel/surfel_groups.h"

namespace depthgrid {

// SLAM's motion from each group to the next, accumulated over the frames between. Where the frame
// before a group's first is tied to an earlier group, also the tie to that group.
std::vector<GroupMotion> MotionsOf(const SurfelGroups& of, const std::vector<MappedFrame>& frames);

// MotionGrowth() at each frame (JointResult::motion_growth, one for each of SLAM's motions between
// the groups): that of the motion which contains it.
std::vector<Eigen::Vector3d> GrowthAt(const std::vector<GroupMotion>& motions,
                                      const std::vector<Eigen::Vector3d>& motion_growth,
                                      const SurfelGroups& of);

// How far the groups (not joined yet) may be joined.
std::vector<GroupStart> StartsOf(const SurfelGroups& of, const std::vector<MappedFrame>& frames);

// The number of groups that an adjustment may have.
GroupLimits LimitsFor(AdjustEffort effort, const JointOptions& joint,
                      const std::vector<GroupStart>& starts);

// Index of the first frame that is not a prior map's.
int FirstNew(const std::vector<MappedFrame>& frames);

}  // namespace depthgrid
