// How well poses that were solved for together are known.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

// Of the errors of these groups, as they go together: three rows a group, in map axes (true pose =
// Exp(error) * pose). `factored` are the equations at the poses, for small motions of the groups in
// their own axes. A group may be asked for more than once.
Eigen::MatrixXd PoseCovariance(const PoseMatrix& factored, const std::vector<Pose2>& map_from_group,
                               std::span<const int> groups);

}  // namespace depthgrid
