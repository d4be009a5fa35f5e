// Signed permutations of axes, which convert between axis conventions.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace depthgrid {

// All 48, those that change the fewest axes first. Half are rotations, the others reflections.
std::vector<Eigen::Matrix3d> AllSignedAxes();

}  // namespace depthgrid
