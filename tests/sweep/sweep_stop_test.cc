// When a point of a sweep has seeds enough, where seeds are crossed.
#include <gtest/gtest.h>

#include "eval/sweep/sweep_results.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using SweepStop = ProgramTest;

// Three seeds of the noise with one of SLAM say nothing of what other errors of SLAM would give: of
// 3 x 3 crossed seeds there are two of each with the fourth run, (2, 1).
TEST_F(SweepStop, CrossedSeedsCountAsManyAsOneOfThemHas) {
  Write("stop.yaml", R"(
experiment: ./small.yaml
axes:
  slam_seed: {seeds: 3}
  depth_seed: {seeds: 3}
stop: {metric: trajectory.slam.mean_euclidean_m, width: 100, min_seeds: 2}
)");
  Succeed("sweep ./stop.yaml -o out");
  EXPECT_EQ(ReadSweep(Path("out")).rows(), 4U);
}

TEST_F(SweepStop, TheMetricThatWasLikelyMeantIsNamed) {
  for (const auto& [given, meant] :
       {std::pair{"mean_euclidean_m", "'trajectory.slam.mean_euclidean_m'"},
        {"trajectory.mean", "'trajectory.est.mean_euclidean_m'"},
        {"trajectory.slam.mean", "'trajectory.slam.mean_euclidean_m'"}}) {
    Write("stop.yaml", std::string("experiment: ./small.yaml\naxes: {seed: {seeds: 3}}\n") +
                           "stop: {metric: " + given + ", width: 100}\n");
    ExpectRefusal("sweep ./stop.yaml -o out",
                  {"stop.yaml:3: stop.metric is '", "did you mean ", meant});
  }
}

}  // namespace
}  // namespace depthgrid
