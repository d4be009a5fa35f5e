// What a sweep says of seeds that are hardly meant, and of runs whose maps are of no use.
#include <gmock/gmock.h>

#include "eval/sweep/sweep_doubts.h"

namespace depthgrid {
namespace {

OccupancyMap OneCell(float occupied_prob) {
  OccupancyMap map(GridGeometry{0.05, {0, 0}, 1, 1});
  map.occupied_prob = {occupied_prob};
  return map;
}

// With any number of processes the second run may end before the first.
TEST(RunDoubts, TheFirstIsThatOfThePlanWhicheverEndsFirst) {
  SweepPlan plan;
  plan.title = "s.yaml";
  plan.parameter_keys = {"seed"};
  for (int run = 0; run < 4; ++run) plan.runs.push_back({run, 0, {std::to_string(run + 10)}});
  TruthRecord truth;
  truth.map = StatesOf(OneCell(0.0F));
  for (const auto& order : {std::vector{0, 1, 2, 3}, {3, 2, 0, 1}, {2, 1, 3, 0}}) {
    RunDoubts doubts;
    for (const int run : order) {
      doubts.Add(plan.runs[static_cast<std::size_t>(run)], OneCell(run == 0 ? 0.0F : 1.0F), truth,
                 {});
    }
    EXPECT_THAT(doubts.Lines(plan),
                testing::ElementsAre(
                    "s.yaml: 3 of 4 runs, the first with seed=11: the map has no free cell"));
  }
}

// `seed: 10` is one run, and hardly meant so.
TEST(LoneSeeds, ASeedThatMayBeACountIsSaid) {
  const auto doubts = [](const std::string& axes) {
    return DoubtsOfLoneSeeds(ReadAxes(Config::FromText(axes, "s.yaml")));
  };
  EXPECT_THAT(doubts("seed: 10\nslam_seed: 3"),
              testing::ElementsAre(
                  "s.yaml:1: axis 'seed' is the one seed 10: write {seeds: 10} where 10 seeds "
                  "are meant, [10] where not",
                  testing::HasSubstr("s.yaml:2: axis 'slam_seed' is the one")));
  EXPECT_THAT(doubts("seed: [10]\nslam_seed: {seeds: 10}\ndepth_seed: 1\nframes: 20"),
              testing::IsEmpty());
  EXPECT_THAT(doubts("trajectory_seed: 20261128"), testing::IsEmpty());  // no count of runs
}

}  // namespace
}  // namespace depthgrid
