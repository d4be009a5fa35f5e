// A part of a recording, by its seconds, and the frames that these are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/slam_output.h"

namespace depthgrid {

// Seconds since the recording's first frame: parts that share an end share no frame.
struct PartOptions {
  double from_s = 0.0;
  double to_s = 0.0;  // frames before it; 0: to the recording's end

  bool IsWhole() const { return from_s == 0.0 && to_s == 0.0; }
  bool Has(double since_first_s) const;

  void Visit(OptionsVisitor& v);
};

// Positions among the frames of the whole recording, by which frames are numbered in its parts too.
struct FramePart {
  std::size_t begin = 0;
  std::size_t end = std::numeric_limits<std::size_t>::max();  // may be beyond the last frame

  bool Has(std::size_t frame) const { return begin <= frame && frame < end; }
  // Both ends and the frame that brings it.
  bool Has(const LoopClosure& loop) const;
  // Of a recording of so many frames.
  std::size_t EndAmong(std::size_t frames) const { return std::min(end, frames); }
  std::size_t CountAmong(std::size_t frames) const { return EndAmong(frames) - begin; }
};

// The frames of the part, of all `stamps_s`, which ascend. Throws InputError where it begins or
// ends beyond the last of them, or holds none. `recording` names it in errors.
FramePart FindPart(const PartOptions& part, const std::vector<double>& stamps_s,
                   const std::string& recording);

}  // namespace depthgrid
