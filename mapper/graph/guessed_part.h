// What was mapped between two losses of SLAM, or since the last one.
#pragma once

#include <algorithm>
#include <vector>

#include "mapper/core/reference_map.h"

namespace depthgrid {

// Mapped frames, by position, whose place relative to the others is a guess.
struct GuessedPart {
  int first = 0;
  int end = 0;  // behind the last

  bool Contains(int mapped) const { return first <= mapped && mapped < end; }
  // Whether a loop between these frames joins it to others.
  bool IsLeftBetween(int a, int b) const { return Contains(a) != Contains(b); }
};

inline bool IsLeftByAny(const GuessedPart& part, const std::vector<PlanarLoop>& loops) {
  return std::any_of(loops.begin(), loops.end(), [&](const PlanarLoop& loop) {
    return part.IsLeftBetween(loop.first, loop.second);
  });
}

}  // namespace depthgrid
