// Drives that one map was made of, by the numbers of its frames.
#pragma once

#include <vector>

namespace depthgrid {

// Whether a frame is the first of another drive than the one before it, by their numbers: those of
// a prior map count up one by one within a drive.
constexpr bool BeginsDrive(int before, int frame) {
  return before < 0 && (frame >= 0 || frame != before + 1);
}

// The numbers that frames of a map get when it is gone on in, from those they have: up to -1, one
// left out between two drives.
std::vector<int> PriorNumbers(const std::vector<int>& frames);

}  // namespace depthgrid
