// The rooms, paths and movers that a sweep names.
#include <gmock/gmock.h>

#include "eval/sweep/sweep_database.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

class SweepRooms : public ProgramTest {
 protected:
  void ExpectSweepRefusal(const std::string& sweep, const std::string& says) const {
    Write("sweep.yaml", "experiment: ./small.yaml\n" + sweep);
    ExpectRefusal("sweep ./sweep.yaml -o out", {says});
    ExpectRefusal("sweep ./sweep.yaml --dry-run -o out", {says});
  }
};

TEST_F(SweepRooms, ANameWithASlipIsRefusedBeforeTheFirstRun) {
  ExpectSweepRefusal("axes: {movers: [none, bob], seed: {seeds: 2}}\n",
                     "./sweep.yaml:2: movers is 'bob', must be none");
  ExpectSweepRefusal("axes:\n  seed: [1]\n  trajectory: [look_around, look]\n",
                     "./sweep.yaml:4: trajectory is 'look', must be one of look_around or a TUM");
  ExpectSweepRefusal("axes: {trajectory: [look_around, ./nope.txt]}\n", "./sweep.yaml:2: ");
  ExpectSweepRefusal("axes: {seed: [1]}\nset: {trajectory: nope}\n",
                     "./sweep.yaml:3: trajectory is 'nope'");
  ExpectSweepRefusal("axes: {seed: [1]}\nset: {movers: bob}\n", "./sweep.yaml:3: movers is 'bob'");
  Write("damaged.txt", "no path\n");
  ExpectSweepRefusal("axes: {trajectory: [look_around, ./damaged.txt]}\n", "damaged.txt");
  ExpectRefusal("sweep kalman_gain --set trajectory=nope -o out",
                {"--set trajectory=nope: trajectory is 'nope', must be one of "});
  Write("small.yaml", std::string(kExperiment) + "movers: bob\n");
  ExpectSweepRefusal("axes: {seed: [1]}\n", "./small.yaml:7: movers is 'bob'");
}

// A path of one room and one of another are crossed: two of the four runs are none.
TEST_F(SweepRooms, NamesThatGoTogetherSomewhereAreRun) {
  std::string other = kRoom;
  other.replace(other.find("look_around"), 11, "another_way");
  Write("other.yaml", other);
  Write("sweep.yaml",
        "experiment: ./small.yaml\naxes:\n  scene: [./room.yaml, ./other.yaml]\n"
        "  trajectory: [look_around, another_way]\n");
  const Outcome outcome = Program("sweep ./sweep.yaml -o out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("2 of 4 runs failed, the first: ./sweep.yaml:4: trajectory"));
}

// One scene has the path and the movers that all runs name: those of the other scene fail.
TEST_F(SweepRooms, ASceneWithoutTheMoversOfAnotherIsRun) {
  std::string other = kRoom;
  other.replace(other.find("look_around"), 11, "another_way");
  other +=
      "movers:\n  visitor:\n    shapes: [{shape: cylinder, radius_m: 0.2, height_m: 1.7}]\n"
      "    there_and_back: true\n    waypoints: [{at: [0.4, 3.4]}, {at: [2.6, 3.4]}]\n";
  Write("other.yaml", other);
  for (const char* set : {"movers: visitor", "trajectory: another_way"}) {
    Write("sweep.yaml", std::string("experiment: ./small.yaml\nset: {") + set +
                            "}\naxes:\n  scene: [./room.yaml, ./other.yaml]\n");
    const Outcome outcome = Program("sweep ./sweep.yaml --force -o " + std::string(1, set[0]));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("1 of 2 runs failed, the first: ./sweep.yaml:2: "));
    EXPECT_THAT(outcome.err, HasSubstr("(scene " + Path("room.yaml") + ")"));
  }
}

TEST_F(SweepRooms, ValuesThatContradictEachOtherAreNamedByTheirLine) {
  Write("sweep.yaml",
        "experiment: ./small.yaml\naxes:\n  sensor.min_range_m: [0.1, 4]\n"
        "  sensor.max_range_m: [3, 8]\n");
  EXPECT_THAT(Program("sweep ./sweep.yaml -o out").err,
              HasSubstr("1 of 4 runs failed, the first: ./sweep.yaml:3: sensor.min_range_m is 4, "
                        "must be below max_range_m, 3"));
}

}  // namespace
}  // namespace depthgrid
