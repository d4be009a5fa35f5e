// Misfit of aligned positions, which the checks of trajectories compare.
#pragma once

#include <optional>
#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

// Root mean square error, metres: after alignment in SE(3) or, where the path is too narrow for it,
// in SE(2) and of xy only. Empty where neither is possible.
std::optional<double> AlignedMisfit(const std::vector<PosePair>& pairs);

// Smaller decreases of the misfit are within the jitter of poses and do not count.
constexpr double kLeastGainM = 0.005;

}  // namespace depthgrid
