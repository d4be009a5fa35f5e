// How noisy matches are against what they claim, as innovations tell: as large as they were said to
// be they are 1 a degree of freedom, squared (covariance matching: Mehra 1972, "Approaches to
// adaptive filtering", IEEE Trans. Automatic Control 17).
#pragma once

#include "mapper/fuse/fusion.h"

namespace depthgrid {

class MatchNoise {
 public:
  // Matches' variances, over those they claim.
  double factor() const { return factor_; }
  // Of an innovation whose covariance was told with this factor.
  void Add(const InnovationSize& size);

 private:
  double factor_ = 1.0;
};

}  // namespace depthgrid
