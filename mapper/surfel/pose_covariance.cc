#include "mapper/surfel/pose_covariance.h"

#include <map>

#include "mapper/fuse/fusion.h"

namespace depthgrid {

Eigen::MatrixXd PoseCovariance(const PoseMatrix& factored, const std::vector<Pose2>& map_from_group,
                               std::span<const int> groups) {
  const auto adjoint_of = [&](int group) {
    return AdjointOf(map_from_group[static_cast<std::size_t>(group)]);
  };
  std::map<int, Eigen::Index> column_of;
  for (const int group : groups) {
    column_of.emplace(group, 3 * static_cast<Eigen::Index>(column_of.size()));
  }
  Eigen::MatrixXd units =
      Eigen::MatrixXd::Zero(factored.size(), 3 * static_cast<Eigen::Index>(column_of.size()));
  for (const auto& [group, column] : column_of) {
    units.block<3, 3>(3 * group, column) = adjoint_of(group).transpose();
  }
  const Eigen::MatrixXd solved = factored.SolveAll(units);
  const auto rows = 3 * static_cast<Eigen::Index>(groups.size());
  Eigen::MatrixXd covariance(rows, rows);
  for (Eigen::Index r = 0; r < rows; r += 3) {
    const int group = groups[static_cast<std::size_t>(r / 3)];
    const Eigen::Matrix3d adjoint = adjoint_of(group);
    for (Eigen::Index c = 0; c < rows; c += 3) {
      const Eigen::Index column = column_of.at(groups[static_cast<std::size_t>(c / 3)]);
      covariance.block<3, 3>(r, c) = adjoint * solved.block<3, 3>(3 * group, column);
    }
  }
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace depthgrid
