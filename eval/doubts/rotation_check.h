// Rotations of an estimate that mean something else than the reference's, told from its positions
// when those fit.
#pragma once

#include <optional>
#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

struct RotationDoubt {
  double error_rad = 0.0;  // of the rotations as they were read, in the middle (median)
  bool w_first = false;    // they fit when their quaternions are read w x y z
  // What is left is constant: the reference's axes in those of the estimate's poses. Empty where
  // nothing is.
  std::optional<Eigen::Quaterniond> estimate_from_reference;
};

// Whether the estimate fits best upside down: a mirror image of a level path does, turned in space.
bool FitsUpsideDown(const std::vector<PosePair>& pairs);
// Whether positions fit, and rotations with them.
bool PosesFit(const std::vector<PosePair>& pairs);

// Empty where positions fit badly or say too little of how the worlds lie (a straight line in
// worlds that are not level, or one that fits upside down), where rotations fit, and where no
// reading of them does.
std::optional<RotationDoubt> CheckRotations(const std::vector<PosePair>& pairs);

}  // namespace depthgrid
