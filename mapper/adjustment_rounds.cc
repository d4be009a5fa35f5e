#include "mapper/adjustment_rounds.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

constexpr double kNeverAgain = 2e9;  // frames

}  // namespace

void RoundOptions::Visit(OptionsVisitor& v) {
  v.Number("first_frames", first_frames, {0, 1e9}, "mapped frames before the first round; 0: none");
  v.Number("growth", growth, {1.1, 1e3},
           "each next round comes at this many times as many mapped frames");
  v.Number("last_frames", last_frames, {0, 1e9}, "mapped frames after which there are no rounds");
  v.Flag("again", again,
         "whether the first frames are gone through again once SLAM's errors are known");
}

bool AdjustmentRounds::BeginIfDue(int frames) {
  if (next_ == 0 || frames < next_ || frames > options_.last_frames) return false;
  next_ = static_cast<int>(std::min(std::ceil(options_.growth * frames), kNeverAgain));
  return true;
}

}  // namespace depthgrid
