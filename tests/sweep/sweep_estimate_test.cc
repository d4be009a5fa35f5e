// How long a sweep is said to take before it starts.
#include <gmock/gmock.h>

#include "eval/sweep/sweep_engine.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

class SweepEstimates : public ProgramTest {
 protected:
  double Seconds(const std::string& axes) const {
    Write("sweep.yaml", "experiment: ./small.yaml\naxes:\n" + axes);
    const SweepPlan plan = ReadSweepPlan(Path("sweep.yaml"), {});
    std::vector<int> runs;
    for (const PlannedRun& run : plan.runs) runs.push_back(run.run);
    return EstimateSweep(plan, runs, {}).cpu_s;
  }
};

// Short runs first or long ones: the same runs. (CPU times on a busy machine vary by a third or so;
// 40 times as many frames take more than ten times as long.)
TEST_F(SweepEstimates, CountTheFramesOfEachRun) {
  const double rising_s = Seconds("  frames: [3, 120]\n");
  const double falling_s = Seconds("  frames: [120, 3]\n");
  EXPECT_LT(rising_s, 2.5 * falling_s);
  EXPECT_LT(falling_s, 2.5 * rising_s);
  const double short_s = Seconds("  frames: [3, 4]\n");
  EXPECT_GT(rising_s, 4.0 * short_s);
}

// Of runs of another kind than the first one those of that kind are timed: large images take
// longer.
TEST_F(SweepEstimates, TimeRunsOfEachKind) {
  const double small_s = Seconds("  \"sensor.width, sensor.height\": [[80, 60], [80, 61]]\n");
  const double mixed_s = Seconds("  \"sensor.width, sensor.height\": [[80, 60], [640, 480]]\n");
  EXPECT_GT(mixed_s, 3.0 * small_s);
}

}  // namespace
}  // namespace depthgrid
