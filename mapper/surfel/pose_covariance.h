// Covariance of jointly adjusted poses.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

// Joint covariance of the errors of these groups: three rows a group, in map axes (true pose =
// Exp(error) * pose). `factored`: the equations for small motions of the groups in their own axes.
// A group may occur more than once.
Eigen::MatrixXd PoseCovariance(const PoseMatrix& factored, const std::vector<Pose2>& map_from_group,
                               std::span<const int> groups);

}  // namespace depthgrid
