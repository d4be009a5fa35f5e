// Symmetric matrices of 3 x 3 by their axes. Eigen's solvers take seconds to compile: once, here.
#pragma once

#include <Eigen/Core>

namespace depthgrid {

struct SymmetricEigen {
  Eigen::Vector3d values;   // in ascending order
  Eigen::Matrix3d vectors;  // a column each, of unit length and at right angles
};

// Of the symmetric matrix whose lower triangle is given: matrix v = value v. Not numbers where the
// matrix has such.
SymmetricEigen EigenOf(const Eigen::Matrix3d& matrix);

// a v = value b v, for a symmetric a and a positive definite b; vectors have v^T b v = 1 instead.
SymmetricEigen GeneralizedEigenOf(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

// The matrix with smaller eigenvalues raised to `least`.
Eigen::Matrix3d WithEigenvaluesAtLeast(const Eigen::Matrix3d& matrix, double least);

}  // namespace depthgrid
