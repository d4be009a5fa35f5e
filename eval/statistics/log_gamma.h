// The logarithm of the gamma function, for several threads at once: std::lgamma also writes a
// global variable, the sign.
#pragma once

#include <math.h>

namespace depthgrid {

inline double LogGamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace depthgrid
