#include "mapper/surfel/pose_covariance.h"

#include <map>
#include <utility>

#include "mapper/fuse/fusion.h"

namespace depthgrid {

Eigen::MatrixXd PoseCovariance(const PoseMatrix& factored, const std::vector<Pose2>& map_from_group,
                               std::span<const int> groups) {
  const auto rows = 3 * static_cast<Eigen::Index>(groups.size());
  Eigen::MatrixXd covariance(rows, rows);
  const auto map_axes = [&](int group) {
    return AdjointOf(map_from_group[static_cast<std::size_t>(group)]);
  };
  std::map<int, Eigen::Index> column_of;
  for (Eigen::Index c = 0; c < rows; c += 3) {
    const int group = groups[static_cast<std::size_t>(c / 3)];
    const auto [known, is_new] = column_of.emplace(group, c);
    if (!is_new) {
      covariance.middleCols<3>(c) = covariance.middleCols<3>(known->second);
      continue;
    }
    const Eigen::Matrix3d adjoint = map_axes(group);
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::VectorXd unit = Eigen::VectorXd::Zero(factored.size());
      unit.segment<3>(3 * group) = adjoint.transpose().col(axis);
      const Eigen::VectorXd solved = factored.Solve(std::move(unit));
      for (Eigen::Index r = 0; r < rows; r += 3) {
        const int other = groups[static_cast<std::size_t>(r / 3)];
        covariance.block<3, 1>(r, c + axis) = map_axes(other) * solved.segment<3>(3 * other);
      }
    }
  }
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace depthgrid
