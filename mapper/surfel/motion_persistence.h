// SLAM's motion errs much as it did just before: where nothing else is seen, its error goes on
// (docs/math.md, "What SLAM gets wrong goes on").
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/surfel/group_links.h"
#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

// By axis (forward, left, yaw): what is left, in the next motion, of the error of one, from 0 (they
// are independent) to below 1. A first-order autoregressive process, told by the signs of the
// errors of `unit` four links apart, both of which were seen along the axis (`shares_seen`, one a
// link, as of SharesSeen): the others' errors are what was made of their neighbours', and would
// confirm it. An axis of few such pairs has what is least of those that tell. 0 on all axes where
// little was seen forward in the mean, since the errors are those of the poses then.
Eigen::Vector3d MotionPersistence(const std::vector<GroupLink>& unit,
                                  const std::vector<Pose2>& map_from_group,
                                  const std::vector<Eigen::Vector3d>& shares_seen);

// Adds the motions, in order of time, to the normal equations: each error e, over its sigma, is
// persistence * that before + something new of variance 1 - persistence^2. One that does not follow
// the motion before it stands for itself.
void AddMotions(const std::vector<GroupLink>& motions, const Eigen::Vector3d& persistence,
                const std::vector<Pose2>& map_from_group, PoseMatrix& h, Eigen::VectorXd& g);

}  // namespace depthgrid
