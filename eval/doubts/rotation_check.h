// Whether an estimate's rotations follow another convention than the reference's, judged where its
// positions fit.
#pragma once

#include <optional>
#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

struct RotationDoubt {
  double error_rad = 0.0;  // median, of the rotations as they were read
  bool w_first = false;    // they fit when the quaternions are read as w x y z
  // Constant remaining rotation: the reference's axes in those of the estimate's poses. Empty if
  // there is none.
  std::optional<Eigen::Quaterniond> estimate_from_reference;
};

// Whether the estimate fits best upside down, as a mirrored level path does after rotation in
// space.
bool FitsUpsideDown(const std::vector<PosePair>& pairs);
// Whether both positions and rotations fit.
bool PosesFit(const std::vector<PosePair>& pairs);

// Empty where positions fit badly or do not determine the alignment (a straight line in worlds that
// are not level, or one that fits upside down), where rotations fit, and where they fit in no
// convention.
std::optional<RotationDoubt> CheckRotations(const std::vector<PosePair>& pairs);

}  // namespace depthgrid
