#include "mapper/frame_timer.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

struct Clocks {
  double cpu_us = 100.0;
  double steady_us = 5000.0;
  int cpu_readings = 0;

  FrameClocks Functions() {
    return {[this] {
              ++cpu_readings;
              return cpu_us;
            },
            [this] { return steady_us; }};
  }
  void Work(double us) {
    cpu_us += us;
    steady_us += us;
  }
};

TEST(FrameTimer, StagesAddUpAndTheProcessorIsAskedTwice) {
  Clocks clocks;
  const FrameClocks functions = clocks.Functions();
  StageTimes times;
  {
    const FrameTimer frame(functions, times);
    for (int i = 0; i < 3; ++i) {
      const StageTimer stage(functions, times.match_us);
      clocks.Work(10.0);
    }
    {
      const StageTimer stage(functions, times.insert_us);
      clocks.Work(5.0);
    }
    clocks.Work(2.0);
  }
  EXPECT_NEAR(times.match_us, 30.0, 1e-9);
  EXPECT_NEAR(times.insert_us, 5.0, 1e-9);
  EXPECT_NEAR(times.total_us, 37.0, 1e-9);
  EXPECT_EQ(clocks.cpu_readings, 2);
}

// Another program had the processor for 63 us of 100 that passed.
TEST(FrameTimer, WhatOthersUseIsNobodys) {
  Clocks clocks;
  const FrameClocks functions = clocks.Functions();
  StageTimes times;
  {
    const FrameTimer frame(functions, times);
    {
      const StageTimer stage(functions, times.scan_us);
      clocks.Work(20.0);
      clocks.steady_us += 63.0;
    }
    const StageTimer stage(functions, times.loops_us);
    clocks.Work(17.0);
  }
  EXPECT_NEAR(times.total_us, 37.0, 1e-9);
  EXPECT_NEAR(times.scan_us, 0.37 * 83.0, 1e-9);
  EXPECT_NEAR(times.scan_us + times.loops_us, times.total_us, 1e-9);
}

TEST(FrameTimer, WithoutClocksTimesStayZero) {
  StageTimes times;
  const FrameClocks none;
  {
    const FrameTimer frame(none, times);
    const StageTimer stage(none, times.fuse_us);
  }
  EXPECT_EQ(times.total_us, 0.0);
  EXPECT_EQ(times.fuse_us, 0.0);
}

}  // namespace
}  // namespace depthgrid
