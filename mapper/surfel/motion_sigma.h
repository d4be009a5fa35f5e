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

// By axis (forward, left, yaw), the share of what is known of each motion that was seen and not
// given by the link itself: 1 - P / sigma^2, where P is the variance that is left of the link's
// error (MacKay 1992, "Bayesian interpolation": the well-determined parameters). `factored` are the
// equations at these poses with the links in them. Of more links than probes P is estimated
// (Tang and Saad 2012, "A probing method for computing the diagonal of a matrix inverse"), always
// in the same way.
std::vector<Eigen::Vector3d> SharesSeen(const std::vector<GroupLink>& motions,
                                        const std::vector<Pose2>& map_from_group,
                                        const PoseMatrix& factored);

// Their mean; one without motions.
Eigen::Vector3d MeanShare(const std::vector<Eigen::Vector3d>& shares);

// Over the root of the share of it that was seen: large where links err by much, and where little
// was seen of them; infinite where nothing was.
Eigen::Vector3d SeenSigma(const Eigen::Vector3d& sigma, const std::vector<Eigen::Vector3d>& shares);

// The standard deviation, over that of `unit`, of SLAM's motions from the adjusted poses, which the
// links have drawn towards them: mean square / share. By the median of their errors: where a
// group sees only walls along one direction nothing but the prior holds it, and a mean square of
// such groups' errors would let go of the prior everywhere. Motions that nobody saw do not count:
// their errors are zero, however wrong they are. `shares_seen`: one a link.
Eigen::Vector3d MotionSigma(const std::vector<GroupLink>& unit,
                            const std::vector<Pose2>& map_from_group,
                            const std::vector<Eigen::Vector3d>& shares_seen);

// How many times `sigma`, that of most motions (MotionSigma), those near each one err by: 1, or
// where it is 5 or more, that. A SLAM that was perfect for long and then drifts would be believed
// to the end, since most of its motions are right. `believed`: the links as they were when the
// poses were adjusted, one for each of `unit` and with any growth in them. Their errors r are set
// against what they should be, r^2 = share * sigma^2, so that where the prior is believed far too
// much, and holds the poses nearly at its own, what pulls at them is seen.
std::vector<Eigen::Vector3d> MotionGrowth(const std::vector<GroupLink>& unit,
                                          const std::vector<GroupLink>& believed,
                                          const std::vector<Pose2>& map_from_group,
                                          const std::vector<Eigen::Vector3d>& shares_seen,
                                          const Eigen::Vector3d& sigma);

}  // namespace depthgrid
