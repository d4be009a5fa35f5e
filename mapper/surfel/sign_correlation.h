// How correlated errors are, from how often their signs agree: wrong associations and outliers
// hardly move it.
#pragma once

#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {

// The correlation of two normal variables whose signs' product (+1 or -1) has this mean: it is
// 2/pi asin(correlation) (Sheppard 1899).
inline double CorrelationOfSigns(double mean_product) { return std::sin(0.5 * kPi * mean_product); }

}  // namespace depthgrid
