// Whether two trajectories are of different points of one robot, such as a laser or camera and the
// base.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

struct LeverArm {
  Eigen::Vector3d arm_m = Eigen::Vector3d::Zero();  // in the axes of each of the estimate's poses
  double misfit_m = 0.0;         // root mean square after alignment, with the poses as they are
  double better_misfit_m = 0.0;  // with the poses moved by the arm
};

// Moves the estimate's poses along their own axes.
std::vector<PosePair> MovedBy(std::vector<PosePair> pairs, const Eigen::Vector3d& arm_m);

// The arm with which the misfit is less than 0.2 times that without. Empty where there is none.
std::optional<LeverArm> FindLeverArm(const std::vector<PosePair>& pairs);

// Whether the true poses turn by 120 degrees or move by 7 m; otherwise drift can look like an arm.
bool TellsArmFromDrift(const std::vector<PosePair>& pairs);

}  // namespace depthgrid
