// Correlation of errors from how often their signs agree, which is robust to outliers.
#pragma once

#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {

// The correlation of two normal variables from the mean product of their signs (+1 or -1), which is
// 2/pi asin(correlation) (Sheppard 1899).
inline double CorrelationOfSigns(double mean_product) { return std::sin(0.5 * kPi * mean_product); }

}  // namespace depthgrid
