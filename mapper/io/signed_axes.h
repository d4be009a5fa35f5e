// Permutations of axes with signs: what one convention's axes are in another's.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace depthgrid {

// All 48, those that change the fewest axes first. Half of them are rotations, the others mirror.
std::vector<Eigen::Matrix3d> AllSignedAxes();

}  // namespace depthgrid
