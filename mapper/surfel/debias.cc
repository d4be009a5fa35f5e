#include "mapper/surfel/debias.h"

#include <Eigen/Cholesky>

#include "mapper/core/symmetric_eigen.h"

namespace depthgrid {

NormalEquations Debiased(const NormalEquations& equations, double threshold) {
  if (threshold <= 0.0) return equations;
  // So that false_h = L L^T exists when the normals are exact; relative to each axis's own unit.
  constexpr double kRidge = 1e-9;
  Eigen::Matrix3d false_h = equations.false_h;
  for (int axis = 0; axis < 3; ++axis) {
    false_h(axis, axis) += kRidge * equations.h(axis, axis) + 1e-12;
  }
  const Eigen::Matrix3d l = false_h.llt().matrixL();
  const auto lower = l.triangularView<Eigen::Lower>();
  // With v = L^-T y the problem is symmetric: L^-1 h L^-T y = lambda y.
  const Eigen::Matrix3d half = lower.solve(equations.h);
  const Eigen::Matrix3d whole = lower.solve(half.transpose());
  const SymmetricEigen axes = EigenOf(0.5 * (whole + whole.transpose()));
  const Eigen::Vector3d g = lower.solve(equations.g);
  NormalEquations debiased;
  debiased.false_h = equations.false_h;
  for (int i = 0; i < 3; ++i) {
    const double lambda = axes.values[i];
    if (lambda <= threshold) continue;
    const double share = 1.0 - threshold / lambda;
    const Eigen::Vector3d y = axes.vectors.col(i);
    const Eigen::Vector3d row = l * y;  // false_h v
    debiased.h += share * lambda * row * row.transpose();
    debiased.g += share * y.dot(g) * row;
  }
  return debiased;
}

}  // namespace depthgrid
