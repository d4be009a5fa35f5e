// Tells the drives that a map was made from by its frame numbers.
#pragma once

#include <vector>

namespace depthgrid {

// Whether frame number `frame` starts a new drive after `before`: within a drive of a prior map,
// numbers increase by one.
constexpr bool BeginsDrive(int before, int frame) {
  return before < 0 && (frame >= 0 || frame != before + 1);
}

// Frame numbers for a finished map used as prior, from its current ones: negative, the last is -1,
// with one number skipped between drives.
std::vector<int> PriorNumbers(const std::vector<int>& frames);

}  // namespace depthgrid
