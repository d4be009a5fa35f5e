#include "mapper/fuse/match_noise.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// Number of innovations of twice the expected chi-square that raise the factor e-fold; 50 gives the
// same results (docs/tried.md, "Consistency").
constexpr double kInnovations = 100.0;
// Limit on chi-square per degree of freedom of a single innovation, as it may be a wrong match.
constexpr double kMostTimes = 4.0;
// The factor is limited, because the innovation contains the prediction's and map's errors too.
constexpr double kLeastFactor = 0.2;
constexpr double kMostFactor = 5.0;

}  // namespace

void MatchNoise::Add(const InnovationSize& size) {
  if (size.directions == 0) return;
  const double times = std::min(size.chi2 / size.directions, kMostTimes);
  factor_ = std::clamp(factor_ * std::exp((times - 1.0) / kInnovations), kLeastFactor, kMostFactor);
}

}  // namespace depthgrid
