// A part of a recording, given in seconds, and its frames.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/slam_output.h"

namespace depthgrid {

// Seconds since the recording's first frame, half-open: adjacent parts share no frame.
struct PartOptions {
  double from_s = 0.0;
  double to_s = 0.0;  // exclusive; 0: the recording's end

  bool IsWhole() const { return from_s == 0.0 && to_s == 0.0; }
  bool Has(double since_first_s) const;

  void Visit(OptionsVisitor& v);
};

// Indices among all frames of the recording; a part's frames keep these numbers.
struct FramePart {
  std::size_t begin = 0;
  std::size_t end = std::numeric_limits<std::size_t>::max();  // may be beyond the last frame

  bool Has(std::size_t frame) const { return begin <= frame && frame < end; }
  // Whether both ends and the reporting frame are in the part.
  bool Has(const LoopClosure& loop) const;
  // For a recording of `frames` frames.
  std::size_t EndAmong(std::size_t frames) const { return std::min(end, frames); }
  std::size_t CountAmong(std::size_t frames) const { return EndAmong(frames) - begin; }
};

// The frames of the part, given all stamps in ascending order. Throws InputError if it begins or
// ends after the last one or has no frame. `recording` names it in errors.
FramePart FindPart(const PartOptions& part, const std::vector<double>& stamps_s,
                   const std::string& recording);

}  // namespace depthgrid
