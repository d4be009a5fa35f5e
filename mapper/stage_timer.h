// Measures stages with a clock given from outside.
#pragma once

#include <functional>

namespace depthgrid {

// Microseconds of CPU time. Only FrameReport::times depends on it; without one they stay zero.
using CpuClock = std::function<double()>;

// Adds the time from construction to destruction to a sum.
class StageTimer {
 public:
  StageTimer(const CpuClock& clock, double& sum_us)
      : clock_(clock), sum_us_(sum_us), start_us_(clock ? clock() : 0.0) {}
  ~StageTimer() {
    if (clock_) sum_us_ += clock_() - start_us_;
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  const CpuClock& clock_;
  double& sum_us_;
  double start_us_;
};

}  // namespace depthgrid
