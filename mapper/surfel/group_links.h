// Constraints between groups other than surfels: SLAM's motion and loops.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

struct GroupLink {
  int first = 0;  // differs from `second`, in either order
  int second = 0;
  Pose2 first_from_second;                          // measured
  Eigen::Vector3d sigma = Eigen::Vector3d::Ones();  // standard deviations, axes of `second`
  double huber_sigmas = 0.0;                        // larger errors count linearly; 0: never
  double cauchy_sigmas = 0.0;                       // scale of Cauchy's weight; 0: none
  bool on_trial = false;                            // as PlanarLoop::on_trial
};

// Error of the link: relative pose of the groups against the measured one, (forward m, left m, yaw
// rad) in axes of `second`.
Eigen::Vector3d LinkError(const GroupLink& link, const std::vector<Pose2>& map_from_group);
// Norm of the error in standard deviations.
double LinkSigmas(const GroupLink& link, const std::vector<Pose2>& map_from_group);

// Derivative of the error by a small motion of `first`; the one by `second` is the identity.
Eigen::Matrix3d ErrorByFirst(const GroupLink& link, const std::vector<Pose2>& map_from_group);

// Adds the link to the normal equations h step = g of small motions of all groups, three rows a
// group.
void AddLink(const GroupLink& link, const std::vector<Pose2>& map_from_group, PoseMatrix& h,
             Eigen::VectorXd& g);

}  // namespace depthgrid
