// Many tests at once: the chance that any of them finds what is not there is kept.
#pragma once

#include <vector>

namespace depthgrid {

// Holm's step-down adjustment (1979): compare each with the level as if it were alone. In the order
// given; the smallest of m is multiplied by m, the next by m - 1, never below one before, at
// most 1.
std::vector<double> HolmAdjusted(const std::vector<double>& p_values);

}  // namespace depthgrid
