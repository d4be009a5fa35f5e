// The transform that aligns an estimated trajectory with its reference before they are compared.
#pragma once

#include <optional>
#include <vector>

#include "eval/metrics/association.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

enum class Alignment {
  kNone,          // as given
  kOrigin,        // the first poses coincide in 6 DoF (evo's --align_origin)
  kPlanarOrigin,  // the first poses' bases coincide: xy and heading only
  kSe2,           // least squares over positions in xy, then rotation about z and shift in xy
  kSe3,           // least squares over positions, rigid (evo's --align)
  kSim3,          // SE(3) with scale (evo's --align --correct_scale)
};

struct Similarity {
  Pose3 reference_from_estimate;
  double scale = 1.0;  // x_reference = scale * R x_estimate + t
};

// Empty when the positions do not determine the rotation, as on a straight line in 3D or at a
// standstill. evo's rule: fewer than dimension - 1 singular values of the covariance exceed machine
// epsilon.
std::optional<Similarity> Align(const std::vector<PosePair>& pairs, Alignment alignment);

// Applies the transform to the estimates, positions and rotations.
std::vector<PosePair> Aligned(std::vector<PosePair> pairs, const Similarity& transform);

}  // namespace depthgrid
