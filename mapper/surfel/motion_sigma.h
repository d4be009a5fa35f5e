// How SLAM's motion errs, as poses adjusted together with all that was seen tell (docs/math.md, "A
// nearly perfect prior").
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/surfel/group_links.h"
#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

// With a smaller share seen the prior's errors are hardly told from those of what is seen.
constexpr double kLeastShareSeen = 0.3;

// By axis (forward, left, yaw), the mean share of what is known of these motions that was seen and
// not given by the links themselves: 1 - P / sigma^2, where P is the variance that is left of a
// link's error (MacKay 1992, "Bayesian interpolation": the well-determined parameters). `factored`
// are the equations at these poses with the links in them. Of more links than probes the sum of P
// is estimated (Hutchinson 1989), always in the same way.
Eigen::Vector3d ShareSeen(const std::vector<GroupLink>& motions,
                          const std::vector<Pose2>& map_from_group, const PoseMatrix& factored);

// The standard deviation, over that of `unit`, of SLAM's motions from the adjusted poses, which the
// links have drawn towards them: mean square / share. By the median of their errors: where a group
// sees only walls along one direction nothing but the prior holds it, and a mean square of such
// groups' errors would let go of the prior everywhere.
Eigen::Vector3d MotionSigma(const std::vector<GroupLink>& unit,
                            const std::vector<Pose2>& map_from_group,
                            const Eigen::Vector3d& share_seen);

}  // namespace depthgrid
