// SLAM's motion errors are correlated in time: where nothing else is observed, the last error is
// continued (docs/math.md, "What SLAM gets wrong goes on").
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/surfel/group_links.h"
#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

// Per axis (forward, left, yaw), the coefficient of a first-order autoregressive process of the
// motions' errors, from 0 (independent) to below 1. Estimated from the signs of the errors of
// `unit` links four apart, both observed along the axis (`shares_seen` of SharesSeen(), one per
// link): errors of unobserved links are predicted by this process itself and would confirm any
// value. An axis with few pairs takes the least value of the others. 0 on all axes where the mean
// share observed forward is small, because then the errors are mostly those of the poses.
Eigen::Vector3d MotionPersistence(const std::vector<GroupLink>& unit,
                                  const std::vector<Pose2>& map_from_group,
                                  const std::vector<Eigen::Vector3d>& shares_seen);

// Adds the motions, in order of time, to the normal equations: each error e / sigma is persistence
// * (the previous one) + an innovation of variance 1 - persistence^2. A motion that does not follow
// the previous one is added on its own. `growth`: the factor of each sigma that is MotionGrowth(),
// empty for none; an error that goes on does not grow with it.
void AddMotions(const std::vector<GroupLink>& motions, const Eigen::Vector3d& persistence,
                const std::vector<Eigen::Vector3d>& growth,
                const std::vector<Pose2>& map_from_group, PoseMatrix& h, Eigen::VectorXd& g);

}  // namespace depthgrid
