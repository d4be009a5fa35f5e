// How far positions are off that were laid over each other: what doubts of a trajectory compare.
#pragma once

#include <optional>
#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

// Root mean square, metres: aligned in SE(3) or, where the path is too narrow for it, in SE(2) and
// in the plane. Empty where neither can be.
std::optional<double> AlignedMisfit(const std::vector<PosePair>& pairs);

// A misfit that falls by less says nothing: it is what poses jitter by.
constexpr double kLeastGainM = 0.005;

}  // namespace depthgrid
