// Eigendecomposition of symmetric 3 x 3 matrices. Eigen's solvers take seconds to compile, so they
// are instantiated only here.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace depthgrid {

struct SymmetricEigen {
  Eigen::Vector3d values;   // in ascending order
  Eigen::Matrix3d vectors;  // in columns, orthonormal
};

// matrix v = value v; only the lower triangle is read. NaN in, NaN out.
SymmetricEigen EigenOf(const Eigen::Matrix3d& matrix);

// a v = value b v, for symmetric a and positive definite b; here vectors have v^T b v = 1.
SymmetricEigen GeneralizedEigenOf(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

// The inverse; empty where an eigenvalue is not positive, as of information without a direction.
std::optional<Eigen::Matrix3d> InverseIfPositive(const Eigen::Matrix3d& matrix);

// The matrix with eigenvalues below `least` raised to it.
Eigen::Matrix3d WithEigenvaluesAtLeast(const Eigen::Matrix3d& matrix, double least);

}  // namespace depthgrid
