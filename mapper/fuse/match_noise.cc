#include "mapper/fuse/match_noise.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// So many innovations that are twice as large as they should be make the factor e times larger; 50
// do the same (docs/tried.md, "Consistency").
constexpr double kInnovations = 100.0;
// A single one counts as so many times too large at most: it may be a wrong match.
constexpr double kMostTimes = 4.0;
// Prediction and map, which are not changed, are in the innovation too.
constexpr double kLeastFactor = 0.2;
constexpr double kMostFactor = 5.0;

}  // namespace

void MatchNoise::Add(const InnovationSize& size) {
  if (size.directions == 0) return;
  const double times = std::min(size.chi2 / size.directions, kMostTimes);
  factor_ = std::clamp(factor_ * std::exp((times - 1.0) / kInnovations), kLeastFactor, kMostFactor);
}

}  // namespace depthgrid
