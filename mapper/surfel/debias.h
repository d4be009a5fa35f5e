// Removes false information from normal equations (docs/math.md, "Debiased information").
#pragma once

#include <Eigen/Core>

namespace depthgrid {

// Normal equations of a least-squares problem in a small motion (forward, left, yaw).
struct NormalEquations {
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();  // sum of w J J^T
  Eigen::Vector3d g = Eigen::Vector3d::Zero();  // -sum of w J e: the step is h^-1 g
  // Sum of w sigma_n^2 Jt Jt^T with Jt the row for the tangent in place of the normal: the expected
  // contribution of the normals' noise sigma_n to `h`, which is no information. In a corridor it is
  // all that `h` has along the axis, and it says "no motion".
  Eigen::Matrix3d false_h = Eigen::Matrix3d::Zero();
};

// Scales h and g in each direction v of h v = lambda false_h v by max(0, 1 - threshold / lambda).
// A threshold of 0 changes nothing.
NormalEquations Debiased(const NormalEquations& equations, double threshold);

}  // namespace depthgrid
