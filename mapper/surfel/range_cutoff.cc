#include "mapper/surfel/range_cutoff.h"

#include <cmath>
#include <numbers>

namespace depthgrid {

// The truncated normal distribution: with h = density / distribution function at the limit the mean
// is -h and the variance 1 - sigmas h - h^2, which is also Fisher's information of the mean.
RangeCutoff CutoffAt(double sigmas) {
  const double density =
      std::exp(-0.5 * sigmas * sigmas) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
  const double below = 0.5 * std::erfc(-sigmas / std::numbers::sqrt2);
  const double h = density / below;
  return {h, 1.0 - sigmas * h - h * h};
}

}  // namespace depthgrid
