// Which loops a SLAM system closes: true ones where the true path comes back to an old view, late
// or missed ones, and false ones between places that only look alike.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/slam_output.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

// Frame `second` sees again what frame `first` saw, after the camera was elsewhere.
struct Revisit {
  int first = 0;
  int second = 0;

  bool operator==(const Revisit&) const = default;
};

// The occasions to close a loop: the first frame of each revisit, and again every repeat_s while it
// lasts. Frames without tracking cannot take part. Ordered by `second`.
std::vector<Revisit> FindRevisits(const Trajectory& truth, const std::vector<bool>& tracked,
                                  const SlamLoopOptions& options);

struct SimulatedLoop {
  LoopClosure closure;
  bool is_true = true;
};

// What SLAM reports of the revisits, ordered by reported_at_frame. A report waits for a tracked
// frame; one that would come after the end is never made.
std::vector<SimulatedLoop> SimulateLoops(const Trajectory& truth, const std::vector<bool>& tracked,
                                         const SlamLoopOptions& options, std::uint64_t seed);

}  // namespace depthgrid
