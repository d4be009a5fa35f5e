// Simulates the loop closures of a SLAM system: true ones at revisits of old views, which may be
// late or missed, and false ones between places that only look alike.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/slam_output.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

// Frame `second` sees the view of frame `first` again, after the camera was elsewhere.
struct Revisit {
  int first = 0;
  int second = 0;

  bool operator==(const Revisit&) const = default;
};

// The opportunities to close a loop: the first frame of each revisit, and another every repeat_s
// while it lasts. Frames without tracking are ignored. Ordered by `second`.
std::vector<Revisit> FindRevisits(const Trajectory& truth, const std::vector<bool>& tracked,
                                  const SlamLoopOptions& options);

struct SimulatedLoop {
  LoopClosure closure;
  bool is_true = true;
};

// The closures SLAM reports, ordered by reported_at_frame. A report waits for a tracked frame;
// reports due after the last frame are dropped.
std::vector<SimulatedLoop> SimulateLoops(const Trajectory& truth, const std::vector<bool>& tracked,
                                         const SlamLoopOptions& options, std::uint64_t seed);

}  // namespace depthgrid
