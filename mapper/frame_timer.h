// Measures a frame and its stages with clocks given from outside.
#pragma once

#include <functional>

#include "mapper/core/frame_report.h"

namespace depthgrid {

// Only FrameReport::times depends on them; without either all times stay zero.
struct FrameClocks {
  // Processor time of the calling thread, microseconds. Mostly a system call (2 us on a virtual
  // machine: docs/bench.md), so a frame asks for it twice.
  std::function<double()> cpu_us;
  // Time that passes, microseconds: a few hundredths of a microsecond. It tells a frame's stages.
  std::function<double()> steady_us;

  explicit operator bool() const { return cpu_us && steady_us; }
};

// Adds the time that passes from construction to destruction to a sum.
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

// A whole frame's processor time at its end, and what the stages took of it: their shares of the
// time that passed. Stages are measured within its life.
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
