// Estimates the noise of SLAM's motion from jointly adjusted poses (docs/math.md, "A nearly perfect
// prior").
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/surfel/group_links.h"
#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

// With a smaller observed share, SLAM's errors can hardly be separated from those of the sightings.
constexpr double kLeastShareSeen = 0.3;

// Per axis (forward, left, yaw), the share of the information on each motion that comes from
// sightings rather than from the link itself: 1 - P / sigma^2, where P is the posterior variance of
// the link's error (MacKay 1992, "Bayesian interpolation": well-determined parameters). `factored`:
// the equations at these poses, links included. With more links than probes, P is estimated (Tang
// and Saad 2012, "A probing method for computing the diagonal of a matrix inverse") with fixed
// probes.
std::vector<Eigen::Vector3d> SharesSeen(const std::vector<GroupLink>& motions,
                                        const std::vector<Pose2>& map_from_group,
                                        const PoseMatrix& factored);

// Mean of the shares; ones if there are none.
Eigen::Vector3d MeanShare(const std::vector<Eigen::Vector3d>& shares);

// `sigma` over the root of the mean share: large where SLAM errs by much or little was observed;
// infinite where nothing was.
Eigen::Vector3d SeenSigma(const Eigen::Vector3d& sigma, const std::vector<Eigen::Vector3d>& shares);

// Standard deviation of SLAM's motion errors, as a multiple of the links' `unit` sigma: squared
// residual / share, because the links draw the adjusted poses towards themselves. By the median:
// where a group sees walls of only one direction, nothing but SLAM holds it, and a mean square over
// such groups would discredit SLAM everywhere. Unobserved motions do not count, as their residuals
// are zero however wrong they are. `shares_seen`: one per link.
Eigen::Vector3d MotionSigma(const std::vector<GroupLink>& unit,
                            const std::vector<Pose2>& map_from_group,
                            const std::vector<Eigen::Vector3d>& shares_seen);

// Local sigma around each motion as a multiple of `sigma` (MotionSigma): 1, or the multiple where
// it is 5 or more, and that of the motion alone where it was seen to be as far off. Otherwise SLAM
// that is perfect for long and then drifts would be trusted to the end, as most of its motions are
// right. `believed`: the links as the poses were adjusted with them, one for each of `unit`, growth
// included. Their residuals r are compared with the expected r^2 = share * sigma^2, each motion's
// with its own, so the growth shows even where SLAM is trusted far too much and hardly lets the
// poses move, and does not feed on itself where a motion is believed far less than its neighbours.
// `before`: the growth in `believed`; empty before the first round, when the shares are not known
// and no motion is judged alone.
std::vector<Eigen::Vector3d> MotionGrowth(const std::vector<GroupLink>& unit,
                                          const std::vector<GroupLink>& believed,
                                          const std::vector<Pose2>& map_from_group,
                                          const std::vector<Eigen::Vector3d>& shares_seen,
                                          const Eigen::Vector3d& sigma,
                                          const std::vector<Eigen::Vector3d>& before);

}  // namespace depthgrid
