// What is known of groups' relative poses apart from surfels: the prior's motion and loops.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

struct GroupLink {
  int first = 0;  // another than `second`, before or after it
  int second = 0;
  Pose2 first_from_second;                          // measured
  Eigen::Vector3d sigma = Eigen::Vector3d::Ones();  // of its error, in axes of `second`
  double huber_sigmas = 0.0;                        // larger errors count linearly; 0: never
  double cauchy_sigmas = 0.0;                       // larger errors count ever less; 0: never
  bool on_trial = false;                            // as of PlanarLoop
};

// The measured relative pose against that of the poses: (forward m, left m, yaw rad) in axes of
// `second`.
Eigen::Vector3d LinkError(const GroupLink& link, const std::vector<Pose2>& map_from_group);
// Its length in standard deviations.
double LinkSigmas(const GroupLink& link, const std::vector<Pose2>& map_from_group);

// How the error changes with a small motion of `first`; with one of `second` it changes by that.
Eigen::Matrix3d ErrorByFirst(const GroupLink& link, const std::vector<Pose2>& map_from_group);

// Adds the link to the normal equations h step = g of small motions of all groups, three rows a
// group.
void AddLink(const GroupLink& link, const std::vector<Pose2>& map_from_group, PoseMatrix& h,
             Eigen::VectorXd& g);

}  // namespace depthgrid
