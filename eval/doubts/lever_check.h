// Whether two trajectories are of different points of one robot: a laser's or a camera's, and its
// base's.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

struct LeverArm {
  Eigen::Vector3d arm_m = Eigen::Vector3d::Zero();  // along the estimate's own axes
  double misfit_m = 0.0;         // root mean square, aligned, with the poses as they are
  double better_misfit_m = 0.0;  // and moved by the arm
};

// With the estimate's poses moved along their own axes.
std::vector<PosePair> MovedBy(std::vector<PosePair> pairs, const Eigen::Vector3d& arm_m);

// The arm with which positions fit at less than 0.2 times the misfit. Empty where there is none.
std::optional<LeverArm> FindLeverArm(const std::vector<PosePair>& pairs);

// Whether the true poses turn by 120 degrees, or go 7 m: where they do neither, drift looks like an
// arm.
bool TellsArmFromDrift(const std::vector<PosePair>& pairs);

}  // namespace depthgrid
