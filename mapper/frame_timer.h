// Measures the time of a frame and its stages with injected clocks.
#pragma once

#include <functional>

#include "mapper/core/frame_report.h"

namespace depthgrid {

// Used for FrameReport::times only; unless both are set, all times stay zero.
struct FrameClocks {
  // CPU time of the calling thread, microseconds. Usually a system call (2 us on a virtual machine:
  // docs/bench.md), so it is read only twice per frame.
  std::function<double()> cpu_us;
  // Wall time, microseconds. A call costs a few hundredths of a microsecond; used for the stages.
  std::function<double()> steady_us;

  explicit operator bool() const { return cpu_us && steady_us; }
};

// Adds the wall time from construction to destruction to a sum.
class StageTimer {
 public:
  StageTimer(const FrameClocks& clocks, double& sum_us)
      : clocks_(clocks), sum_us_(sum_us), start_us_(clocks ? clocks.steady_us() : 0.0) {}
  ~StageTimer() {
    if (clocks_) sum_us_ += clocks_.steady_us() - start_us_;
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  const FrameClocks& clocks_;
  double& sum_us_;
  double start_us_;
};

// On destruction, sets a frame's CPU time and scales its stages' wall times to shares of it. Stage
// timers must live within its lifetime.
class FrameTimer {
 public:
  FrameTimer(const FrameClocks& clocks, StageTimes& times)
      : clocks_(clocks),
        times_(times),
        start_cpu_us_(clocks ? clocks.cpu_us() : 0.0),
        start_us_(clocks ? clocks.steady_us() : 0.0) {}
  ~FrameTimer() {
    if (!clocks_) return;
    const double passed_us = clocks_.steady_us() - start_us_;
    times_.total_us = clocks_.cpu_us() - start_cpu_us_;
    if (passed_us <= 0.0) return;
    for (double* stage_us : {&times_.scan_us, &times_.match_us, &times_.fuse_us, &times_.insert_us,
                             &times_.loops_us}) {
      *stage_us *= times_.total_us / passed_us;
    }
  }
  FrameTimer(const FrameTimer&) = delete;
  FrameTimer& operator=(const FrameTimer&) = delete;

 private:
  const FrameClocks& clocks_;
  StageTimes& times_;
  double start_cpu_us_;
  double start_us_;
};

}  // namespace depthgrid
