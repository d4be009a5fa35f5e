#include "mapper/core/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace depthgrid {

SymmetricEigen EigenOf(const Eigen::Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricEigen GeneralizedEigenOf(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(a, b);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::Matrix3d WithEigenvaluesAtLeast(const Eigen::Matrix3d& matrix, double least) {
  const SymmetricEigen axes = EigenOf(matrix);
  return axes.vectors * axes.values.cwiseMax(least).asDiagonal() * axes.vectors.transpose();
}

std::optional<Eigen::Matrix3d> InverseIfPositive(const Eigen::Matrix3d& matrix) {
  const SymmetricEigen axes = EigenOf(matrix);
  if (!(axes.values[0] > 0.0)) return std::nullopt;
  return axes.vectors * axes.values.cwiseInverse().asDiagonal() * axes.vectors.transpose();
}

}  // namespace depthgrid
