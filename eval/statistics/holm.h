// Correction for multiple tests: keeps the probability of any false positive at the level.
#pragma once

#include <vector>

namespace depthgrid {

// Holm's step-down adjustment (1979); each adjusted p-value is compared with the level as if it
// were the only one. The smallest of m is multiplied by m, the next by m - 1 and so on; none is
// below a smaller one's or above 1. Returned in the order given.
std::vector<double> HolmAdjusted(const std::vector<double>& p_values);

}  // namespace depthgrid
