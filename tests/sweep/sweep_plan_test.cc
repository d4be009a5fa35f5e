// Which runs a sweep's file asks for.
#include "eval/sweep/sweep_plan.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "eval/sweep/slurm.h"
#include "mapper/core/error.h"
#include "tests/io/temporary_folder.h"
#include "tests/paths.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;

class SweepPlanTest : public TemporaryFolderTest {
 protected:
  SweepPlan PlanOf(const std::string& text) {
    Write("small.yaml", "scene: living_room\nframes: 9\n");
    Write("sweep.yaml", "experiment: ./small.yaml\n" + text);
    return ReadSweepPlan(Path("sweep.yaml"), {});
  }
  // What is said of the sweep `name`, with the folder as ~.
  std::vector<std::string> SaidOf(const std::string& name,
                                  const std::vector<std::string>& set = {}) const {
    std::vector<std::string> said;
    for (const std::string& warning : ReadSweepPlan(Path(name), set).warnings) {
      said.push_back(Short(warning));
    }
    return said;
  }
  // The values of one key over the runs.
  static std::vector<std::string> ValuesOf(const SweepPlan& plan, const std::string& key) {
    const auto& keys = plan.parameter_keys;
    const auto at =
        static_cast<std::size_t>(std::find(keys.begin(), keys.end(), key) - keys.begin());
    std::vector<std::string> values;
    for (const PlannedRun& run : plan.runs) values.push_back(run.values.at(at));
    return values;
  }
  static std::vector<int> PointsOf(const SweepPlan& plan) {
    std::vector<int> points;
    for (const PlannedRun& run : plan.runs) points.push_back(run.point);
    return points;
  }
};

TEST_F(SweepPlanTest, RangesIncludeBothEnds) {
  const SweepPlan plan = PlanOf("axes: {mapper.fusion.gain: {from: 0, to: 1, count: 5}}\n");
  EXPECT_THAT(ValuesOf(plan, "mapper.fusion.gain"), ElementsAre("0", "0.25", "0.5", "0.75", "1"));
  const SweepPlan log =
      PlanOf("axes: {slam.drift_scale: {from: 0.25, to: 4, count: 3, scale: log}}\n");
  EXPECT_THAT(ValuesOf(log, "slam.drift_scale"), ElementsAre("0.25", "1", "4"));
  // Not 0.9999999999999999 and 9.999999999999998, as the power gives them.
  const SweepPlan decades =
      PlanOf("axes: {slam.drift_scale: {from: 0.1, to: 100, count: 4, scale: log}}\n");
  EXPECT_THAT(ValuesOf(decades, "slam.drift_scale"), ElementsAre("0.1", "1", "10", "100"));
  const SweepPlan thirds = PlanOf("axes: {slam.drift_scale: {from: 0, to: 1, count: 4}}\n");
  EXPECT_THAT(ValuesOf(thirds, "slam.drift_scale"),
              ElementsAre("0", "0.3333333333333333", "0.6666666666666666", "1"));
}

TEST_F(SweepPlanTest, RangesOfWholeNumbersAreWhole) {
  const SweepPlan log =
      PlanOf("axes: {mapper.submap.scans: {from: 5, to: 20, count: 4, scale: log}}\n");
  EXPECT_THAT(ValuesOf(log, "mapper.submap.scans"), ElementsAre("5", "8", "13", "20"));
  // Each as often as the others, either way round.
  for (const std::string range : {"{from: 5, to: 7}", "{from: 7, to: 5}"}) {
    const SweepPlan drawn =
        PlanOf("mode: random\nsamples: 300\naxes: {mapper.submap.scans: " + range + "}\n");
    const std::vector<std::string> values = ValuesOf(drawn, "mapper.submap.scans");
    ASSERT_EQ(values.size(), 300U);
    int counted = 0;
    for (const char* value : {"5", "6", "7"}) {
      const auto times = static_cast<int>(std::count(values.begin(), values.end(), value));
      EXPECT_NEAR(times, 100, 25) << range << " " << value;
      counted += times;
    }
    EXPECT_EQ(counted, 300) << range;
  }
  EXPECT_THROW(PlanOf("axes: {mapper.submap.scans: {from: 0.5, to: 7, count: 3}}\n"), InputError);
  EXPECT_THAT(
      RefusalOf([&] { PlanOf("axes: {mapper.submap.scans: {from: 1, to: 3, count: 5}}\n"); }),
      testing::EndsWith("axis 'mapper.submap.scans' has the value 2 twice: give a smaller count"));
}

// A shipped experiment names no files: those of the sweep lie beside it.
TEST_F(SweepPlanTest, FilesBesideAShippedExperimentAreThoseOfTheSweep) {
  Write("room.ply", "");
  Write("own.yaml",
        "experiment: living_room\nset: {scene: ./room.ply}\naxes: {seed: {seeds: 2}}\n");
  EXPECT_THAT(ReadSweepPlan(Path("own.yaml"), {}).experiment_yaml,
              testing::HasSubstr("scene: " + Path("room.ply") + "\n"));
}

TEST_F(SweepPlanTest, SeedsRepeatPointsWhereverTheyStand) {
  const SweepPlan plan = PlanOf(
      "axes:\n  seed: {seeds: 2, first: 7}\n  mapper.fusion.gain: [0, 1.0]\n"
      "  depth_seed: [1, 2]\n");
  EXPECT_THAT(plan.parameter_keys, ElementsAre("seed", "mapper.fusion.gain", "depth_seed"));
  EXPECT_THAT(PointsOf(plan), ElementsAre(0, 0, 0, 0, 1, 1, 1, 1));
  EXPECT_THAT(ValuesOf(plan, "seed"), ElementsAre("7", "7", "8", "8", "7", "7", "8", "8"));
  EXPECT_THAT(ValuesOf(plan, "depth_seed"), ElementsAre("1", "2", "1", "2", "1", "2", "1", "2"));
  EXPECT_THAT(ValuesOf(plan, "mapper.fusion.gain"),
              ElementsAre("0", "0", "0", "0", "1", "1", "1", "1"));
  EXPECT_EQ(plan.OptionsOf(plan.runs[2]).seed, 8U);
}

TEST_F(SweepPlanTest, SeedsEndAtTheLargest) {
  EXPECT_THAT(ValuesOf(PlanOf("axes: {seed: {seeds: 2, first: 18446744073709551614}}\n"), "seed"),
              ElementsAre("18446744073709551614", "18446744073709551615"));
  EXPECT_THAT(RefusalOf([&] {
                PlanOf(
                    "axes:\n  frames: [5, 6]\n"
                    "  seed: {seeds: 3, first: 18446744073709551614}\n");
              }),
              testing::EndsWith("sweep.yaml:4: 3 seeds from 18446744073709551614 on go beyond "
                                "18446744073709551615, the largest there is"));
}

TEST_F(SweepPlanTest, KeysWithoutEffectAreRefused) {
  const auto refusal = [&](const std::string& line) {
    return RefusalOf([&] { PlanOf("axes: {seed: {seeds: 9}}\n" + line + "\n"); });
  };
  const std::string stop = "sweep.yaml:3: stop needs a 'metric' and a 'width' above 0";
  EXPECT_THAT(refusal("stop: {metric: map.coverage}"), testing::EndsWith(stop));
  EXPECT_THAT(refusal("stop: {width: 0.1}"), testing::EndsWith(stop));
  EXPECT_THAT(refusal("samples: 5"),
              testing::EndsWith("yaml:3: 'samples' is for mode random alone"));
  EXPECT_THAT(refusal("sample_seed: 5"),
              testing::EndsWith("'sample_seed' is for mode random alone"));
  EXPECT_THAT(refusal("stop: {metric: map.coverage, width: -1}"),
              testing::EndsWith("sweep.yaml:3: stop.width is -1, must be above 0"));
  EXPECT_EQ(refusal("stop: {metric: map.coverage, width: 0.1}"), "no error");
}

TEST_F(SweepPlanTest, AStopThatCannotActIsSaid) {
  const std::string stop = "stop: {metric: map.coverage, width: 0.1, min_seeds: 4}\n";
  const auto doubts = [&](const std::string& axes) {
    Write("small.yaml", "scene: living_room\nsensor: {noise: handa}\n");
    Write("sweep.yaml", "experiment: ./small.yaml\n" + axes + stop);
    return SaidOf("sweep.yaml");
  };
  const std::string never =
      "~/sweep.yaml:3: stop has no effect: min_seeds is 4, must be below the ";
  EXPECT_THAT(doubts("axes: {seed: {seeds: 4}}\n"),
              ElementsAre(never + "4 runs that a point has over the seeds"));
  EXPECT_THAT(doubts("axes: {mapper.grid.resolution_m: [0.05, 0.1]}\n"),
              ElementsAre(never + "1 run that a point has over the seeds"));
  EXPECT_THAT(doubts("axes: {seed: {seeds: 5}}\n"), ElementsAre());
}

TEST_F(SweepPlanTest, ErrorsOfItsPartsNameTheLine) {
  EXPECT_THAT(RefusalOf([&] { PlanOf("mode: grid\naxes: {}\n"); }),
              testing::EndsWith("sweep.yaml:3: has no axes"));
  EXPECT_THAT(RefusalOf([&] {
                PlanOf("axes: {seed: {seeds: 9}}\nstop:\n  width: 1\n  metric: map.all.chamfer\n");
              }),
              testing::HasSubstr("sweep.yaml:5: stop.metric is 'map.all.chamfer', must be"));
}

// It would be an axis of a name of its own that sets the seed all the same.
TEST_F(SweepPlanTest, AnAxisIsAKey) {
  EXPECT_THAT(RefusalOf([&] { PlanOf("axes: {seed.: [1, 2]}\n"); }),
              testing::EndsWith("sweep.yaml:2: 'seed.' is no key: a name in it is empty"));
}

TEST_F(SweepPlanTest, ZipTakesValuesTogetherAndStillCrossesSeeds) {
  const SweepPlan plan =
      PlanOf("mode: zip\naxes: {frames: [5, 6], mapper.fusion.gain: [0, 1], seed: {seeds: 3}}\n");
  EXPECT_THAT(ValuesOf(plan, "frames"), ElementsAre("5", "5", "5", "6", "6", "6"));
  EXPECT_THAT(ValuesOf(plan, "mapper.fusion.gain"), ElementsAre("0", "0", "0", "1", "1", "1"));
  EXPECT_THAT(ValuesOf(plan, "seed"), ElementsAre("1", "2", "3", "1", "2", "3"));
}

TEST_F(SweepPlanTest, KeysOfOneAxisChangeTogether) {
  const SweepPlan plan = PlanOf(
      "axes:\n  'sensor.noise, sensor.noise_scale': [[none, 1], [handa, 4]]\n  frames: [5, 6]\n");
  EXPECT_THAT(ValuesOf(plan, "sensor.noise"), ElementsAre("none", "none", "handa", "handa"));
  EXPECT_THAT(ValuesOf(plan, "sensor.noise_scale"), ElementsAre("1", "1", "4", "4"));
}

TEST_F(SweepPlanTest, RandomSamplesAreTheSameEveryTimeAndInRange) {
  const std::string text =
      "mode: random\nsamples: 100\naxes:\n  mapper.fusion.gain: {from: 0.2, to: 0.4}\n"
      "  slam.drift_scale: {from: 0.01, to: 100, scale: log}\n  frames: [5, 6]\n"
      "  seed: {seeds: 2}\n";
  const SweepPlan plan = PlanOf(text);
  ASSERT_EQ(plan.runs.size(), 200U);
  EXPECT_EQ(ValuesOf(plan, "mapper.fusion.gain"), ValuesOf(PlanOf(text), "mapper.fusion.gain"));
  EXPECT_NE(ValuesOf(plan, "mapper.fusion.gain"),
            ValuesOf(PlanOf("sample_seed: 2\n" + text), "mapper.fusion.gain"));
  int below_one = 0;
  for (const std::string& value : ValuesOf(plan, "slam.drift_scale")) {
    EXPECT_TRUE(std::stod(value) > 0.01 && std::stod(value) < 100.0) << value;
    below_one += std::stod(value) < 1.0 ? 1 : 0;
  }
  EXPECT_GT(below_one, 70);  // half of 200, the log's middle being 1
  EXPECT_LT(below_one, 130);
  for (const std::string& value : ValuesOf(plan, "mapper.fusion.gain")) {
    EXPECT_TRUE(std::stod(value) > 0.2 && std::stod(value) < 0.4) << value;
  }
}

TEST_F(SweepPlanTest, RunsThatDifferInTheMapperAloneAreOneGroup) {
  const SweepPlan plan = PlanOf(
      "axes: {mapper.fusion.gain: [0, 1], mapper.scan.beams: [100, 200], seed: {seeds: 2}}\n");
  EXPECT_THAT(ScanGroups(plan), ElementsAre(0, 1, 2, 3, 0, 1, 2, 3));
}

TEST_F(SweepPlanTest, ShardsArePartsOfTheWhole) {
  const SweepPlan plan = PlanOf("axes: {mapper.fusion.gain: [0, 1], seed: {seeds: 7}}\n");
  std::multiset<int> runs;
  for (int index = 1; index <= 3; ++index) {
    for (const PlannedRun& run : RunsOf(plan, {index, 3})) runs.insert(run.run);
  }
  EXPECT_EQ(runs.size(), 14U);
  EXPECT_EQ(std::set<int>(runs.begin(), runs.end()).size(), 14U);
}

TEST_F(SweepPlanTest, TheSameSweepSaysTheSameOfItself) {
  const std::string text = "axes: {mapper.fusion.gain: [0, 0.5, 1], seed: [1, 2]}\n";
  const std::string other =
      "axes: {mapper.fusion.gain: {from: 0, to: 1, count: 3}, seed: {seeds: 2}}\n";
  EXPECT_EQ(PlanOf(text).sweep_text, PlanOf(other).sweep_text);
  EXPECT_NE(PlanOf(text).sweep_text,
            PlanOf("axes: {mapper.fusion.gain: [0, 0.5, 1], seed: [1, 3]}\n").sweep_text);
}

// Of the experiment's file, of the sweep's and of the command line; once, and not where any run has
// use for it.
TEST_F(SweepPlanTest, SettingsWithoutEffectInAnyRunAreSaid) {
  Write("idle.yaml",
        "scene: living_room\nslam: {profile: orb_slam2}\nmapper: {fusion: {gain: 0.1}}\n");
  const auto doubts = [&](const std::string& text, const std::vector<std::string>& set) {
    Write("sweep.yaml", "experiment: ./idle.yaml\n" + text);
    return SaidOf("sweep.yaml", set);
  };
  const std::string seeds = "axes: {seed: {seeds: 3}}\n";
  const std::string why = "has no effect because mapper.fusion.mode is learned";
  EXPECT_THAT(doubts(seeds, {}), ElementsAre("~/./idle.yaml:3: mapper.fusion.gain " + why));
  EXPECT_THAT(doubts(seeds + "set: {mapper.fusion.gain: 0.2}\n", {}),
              ElementsAre("~/sweep.yaml:3: mapper.fusion.gain " + why));
  EXPECT_THAT(doubts(seeds, {"mapper.fusion.gain=0.3"}),
              ElementsAre("--set mapper.fusion.gain=0.3: " + why));
  EXPECT_THAT(doubts("axes: {mapper.fusion.mode: [learned, fixed]}\n", {}), ElementsAre());
  EXPECT_THAT(doubts(seeds, {"mapper.fusion.mode=fixed"}), ElementsAre());
}

TEST_F(SweepPlanTest, RunsThatRepeatAnotherAreSaid) {
  const auto doubts = [&](const std::string& text) { return PlanOf(text).warnings; };
  EXPECT_THAT(
      doubts("axes:\n  slam.profile: [ground_truth, orb_slam2]\n"
             "  slam.drift_scale: [1, 3, 10]\n"),
      ElementsAre("sweep: 2 of 6 runs repeat another: there slam.drift_scale has no effect"));
  EXPECT_THAT(doubts("axes: {slam_seed: {seeds: 3}, mapper.fusion.gain: [0.1, 0.2]}\n"
                     "set: {mapper.fusion.mode: learned}\n"),
              ElementsAre("sweep: 5 of 6 runs repeat another: there mapper.fusion.gain, slam_seed "
                          "have no effect"));
  EXPECT_THAT(
      doubts("axes: {sensor.noise: [none, handa], sensor.noise_scale: [1, 2]}\n"),
      ElementsAre("sweep: 1 of 4 runs repeats another: there sensor.noise_scale has no effect"));
  EXPECT_THAT(doubts("axes: {mapper.method: [paper, surfel], mapper.surfel.stay_m: [0.05, 0.1]}\n"),
              ElementsAre("sweep: 1 of 4 runs repeats another: there mapper.surfel.stay_m has no "
                          "effect"));
  EXPECT_THAT(doubts("axes: {mapper.scan.floor_z_m: [0, 0.5, 1]}\n"),
              ElementsAre("sweep: 2 of 3 runs repeat another: there mapper.scan.floor_z_m has no "
                          "effect"));
  EXPECT_THAT(doubts("axes: {slam.drift_scale: [1, 2], slam.drift_speed_mps: [0.1]}\n"),
              ElementsAre());
  EXPECT_THAT(doubts("axes: {seed: {seeds: 3}, mapper.fusion.mode: [fixed, learned]}\n"
                     "set: {sensor.noise: handa}\n"),
              ElementsAre());
}

TEST_F(SweepPlanTest, PointsDrawnAgainAreSaid) {
  EXPECT_THAT(PlanOf("mode: random\nsamples: 5\n"
                     "axes: {frames: [5], seed: {seeds: 2}}\nset: {sensor.noise: handa}\n")
                  .warnings,
              ElementsAre("sweep: 8 of 10 runs repeat another: the same values are drawn again"));
}

TEST_F(SweepPlanTest, CamerasThatAreHardlyMeantAreSaid) {
  const auto doubts = [&](const std::string& axes) { return PlanOf(axes).warnings; };
  EXPECT_THAT(doubts("axes: {sensor.width: [640, 320]}\n"),
              ElementsAre("sweep: sensor.width 320 and height 480 scale the camera's focal lengths "
                          "to 240.6 and 480 pixels: scale both by one factor, or set "
                          "sensor.hfov_deg, which makes square pixels"));
  EXPECT_THAT(doubts("axes: {sensor.fx: [100, 200, 480]}\n"),
              ElementsAre("sweep: sensor.fx is 100 and fy 480, of which only fx was set: set both "
                          "(the first of 2 such warnings)"));
  EXPECT_THAT(doubts("axes: {\"sensor.width, sensor.height\": [[640, 480], [320, 240]]}\n"),
              ElementsAre());
}

// The axis decides in every run.
TEST_F(SweepPlanTest, WhatIsSetOfAnAxisIsSaid) {
  Write("small.yaml", "scene: living_room\n");
  Write("gains.yaml",
        "experiment: ./small.yaml\nset: {frames: 9, mapper.fusion.mode: fixed}\n"
        "axes: {mapper.fusion.mode: [fixed], mapper.fusion.gain: [0, 1]}\n");
  EXPECT_THAT(SaidOf("gains.yaml", {"frames=8", "mapper.fusion.gain=0.7"}),
              ElementsAre("~/gains.yaml:2: mapper.fusion.mode: has no effect because "
                          "mapper.fusion.mode is an axis of the sweep",
                          "--set mapper.fusion.gain=0.7: has no effect because "
                          "mapper.fusion.gain is an axis of the sweep"));
}

TEST_F(SweepPlanTest, AScenarioThatSetsNothingIsSaid) {
  Write("said.yaml",
        "scene: living_room\n"
        "slam: {profile: orb_slam2, loops: {recall: 1, precision: 1, delay_frames: 0}}\n");
  Write("late.yaml",
        "experiment: ./said.yaml\nset: {frames: 9, slam.loops.scenario: late}\n"
        "axes: {slam.drift_scale: [1, 2]}\n");
  EXPECT_THAT(
      SaidOf("late.yaml"),
      ElementsAre(
          "~/late.yaml:2: slam.loops.scenario has no effect because all keys that it sets are "
          "given"));
}

TEST_F(SweepPlanTest, WhatIsNoSweepIsSaidToBeWhatItIs) {
  const auto refusal = [&](const std::string& text) {
    Write("other.yaml", text);
    return Short(RefusalOf([&] { ReadSweepPlan(Path("other.yaml"), {}); }));
  };
  EXPECT_EQ(refusal("scene: living_room\nframes: 9\n"),
            "~/other.yaml: is an experiment; `depthgrid run` takes it");
  EXPECT_EQ(refusal("frames: 9\ncases: [{name: a, scene: living_room}]\n"),
            "~/other.yaml: holds several experiments; only `depthgrid run` takes it");
}

TEST_F(SweepPlanTest, WhatStaysBesideAnotherProfileIsSaid) {
  Write("drifts.yaml",
        "scene: living_room\nslam: {profile: orb_slam2, drift_scale: 20}\n"
        "mapper: {fusion: {mode: fixed}}\n");
  const auto doubts = [&](const std::string& text, const std::vector<std::string>& set = {}) {
    Write("drifts_sweep.yaml", "experiment: ./drifts.yaml\n" + text);
    return ReadSweepPlan(Path("drifts_sweep.yaml"), set).warnings;
  };
  const std::string kept = "./drifts.yaml: its own values of slam.drift_scale are kept with ";
  EXPECT_THAT(doubts("axes: {slam.profile: [orb_slam2, planar_slam]}\n"),
              ElementsAre(kept + "slam.profile=orb_slam2, planar_slam"));
  const std::string gains = "axes: {mapper.fusion.gain: [0, 1]}\n";
  EXPECT_THAT(doubts(gains + "set: {slam.profile: planar_slam}\n"),
              ElementsAre(kept + "slam.profile=planar_slam"));
  EXPECT_THAT(doubts(gains, {"slam.profile=planar_slam"}),
              ElementsAre(kept + "slam.profile=planar_slam"));
  EXPECT_THAT(doubts(gains, {"slam.profile=planar_slam", "slam.drift_scale=37.5"}), ElementsAre());
  EXPECT_THAT(
      doubts("axes: {'slam.profile, slam.drift_scale': [[orb_slam2, 20], [planar_slam, 9]]}\n"),
      ElementsAre());
  EXPECT_THAT(doubts("axes: {slam.profile: [orb_slam2, ground_truth]}\n"), ElementsAre());
  EXPECT_THAT(doubts(gains), ElementsAre());
}

TEST_F(SweepPlanTest, EveryShippedSweepIsSound) {
  int sweeps = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(kSourceFolder) / "scenes/sweeps")) {
    const SweepPlan plan = ReadSweepPlan(entry.path().string(), {});
    EXPECT_GE(plan.runs.size(), 50U) << entry.path();
    EXPECT_THAT(plan.warnings, ElementsAre()) << entry.path();
    ++sweeps;
  }
  EXPECT_GE(sweeps, 7);
}

TEST(SlurmArray, IsWrittenInRanges) {
  EXPECT_EQ(ArrayText({1, 2, 3, 7}), "1-3,7");
  EXPECT_EQ(ArrayText({4}), "4");
  EXPECT_EQ(ArrayText({1, 3, 4}), "1,3-4");
}

TEST_F(SweepPlanTest, AnExperimentThatIsNotThereIsNamedByItsLine) {
  Write("lost.yaml", "axes: {seed: {seeds: 2}}\nexperiment: nope\n");
  EXPECT_THAT(RefusalOf([&] { ReadSweepPlan(Path("lost.yaml"), {}); }),
              testing::HasSubstr("lost.yaml:2: nope: no shipped experiment"));
}

}  // namespace
}  // namespace depthgrid
