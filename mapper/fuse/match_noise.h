// Ratio of the matches' actual to claimed variance, estimated from innovations, whose chi-square
// per degree of freedom should be 1 (covariance matching: Mehra 1972, "Approaches to adaptive
// filtering", IEEE Trans. Automatic Control 17).
#pragma once

#include "mapper/fuse/fusion.h"

namespace depthgrid {

class MatchNoise {
 public:
  // Actual over claimed variance of matches.
  double factor() const { return factor_; }
  // Adds an innovation whose covariance was computed with the present factor.
  void Add(const InnovationSize& size);

 private:
  double factor_ = 1.0;
};

}  // namespace depthgrid
