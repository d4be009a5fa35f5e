// The logarithm of the gamma function, thread-safe: std::lgamma writes the sign to a global
// variable.
#pragma once

#include <math.h>

namespace depthgrid {

inline double LogGamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace depthgrid
