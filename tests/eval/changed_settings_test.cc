#include "eval/experiment/changed_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eval/experiment/experiment_options.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> ChangedBy(const std::vector<std::string>& assignments) {
  Config config;
  for (const std::string& assignment : assignments) config.Set(assignment);
  ExperimentOptions options;
  config.Read(options);
  return ChangedSettings(Config::FromText(ToYaml(options), "run.yaml"));
}

TEST(ChangedSettings, AreThoseThatAreNotTheDefaults) {
  EXPECT_THAT(ChangedBy({}), IsEmpty());
  EXPECT_THAT(ChangedBy({"scene=living_room", "seed=7", "mapper.fusion.mode=fixed"}), IsEmpty());
  EXPECT_THAT(ChangedBy({"mapper.grid.resolution_m=0.02", "sensor.width=80", "slam_seed=3"}),
              ElementsAre("slam_seed 3", "sensor.width 80", "mapper.grid.resolution_m 0.02"));
}

TEST(ChangedSettings, AProfilesOwnValuesAreDefaults) {
  EXPECT_THAT(ChangedBy({"slam.profile=orb_slam2"}), IsEmpty());
  EXPECT_THAT(ChangedBy({"slam.profile=orb_slam2", "slam.drift_scale=3"}),
              ElementsAre("slam.drift_scale 3"));
}

TEST(ChangedSettings, KeysOfOtherVersionsAreNoMatter) {
  EXPECT_THAT(ChangedSettings(Config::FromText(
                  "slam: {profile: gone}\nold: {key: 1}\nsensor: {width: 5}\n", "run.yaml")),
              ElementsAre("sensor.width 5"));
}

std::string PoseSourceWith(const std::vector<std::string>& assignments) {
  Config config;
  for (const std::string& assignment : assignments) config.Set(assignment);
  ExperimentOptions options;
  config.Read(options);
  return PoseSourceOf(Config::FromText(ToYaml(options), "run.yaml"));
}

// Fitted settings are those of true poses, and errors.
TEST(PoseSource, IsNotTheTruthWhereItErrs) {
  EXPECT_EQ(PoseSourceWith({}), "ground_truth");
  EXPECT_EQ(PoseSourceWith({"slam.profile=orb_slam2", "slam.drift_scale=3"}), "orb_slam2");
  EXPECT_EQ(PoseSourceWith({"slam.jitter_rotation_deg=0.1"}), "own settings over ground_truth");
  EXPECT_EQ(PoseSourceWith({"slam.jump_translation_m=1"}), "ground_truth");  // never jumps
  EXPECT_EQ(PoseSourceOf(Config::FromText("mapper: {method: paper}\n", "run.yaml")), "");
  EXPECT_EQ(PoseSourceOf(Config::FromText("slam: {profile: gone}\n", "run.yaml")), "gone");
}

TEST(MeasuredSettings, LeaveOutWhatVaries) {
  const Config experiment = Config::FromText(
      "scene: rooms/den.yaml\nframes: 60\ntrajectory: handheld\nseed: 1\n"
      "slam: {profile: orb_slam2}\nmapper: {method: paper, fusion: {mode: fixed, gain: 0.5}}\n",
      "run.yaml");
  EXPECT_EQ(MeasuredSettings(experiment, {"seed"}, ""),
            "den, 60 frames, trajectory handheld, SLAM orb_slam2, mapper paper, fusion fixed, gain "
            "0.5");
  EXPECT_EQ(
      MeasuredSettings(
          experiment,
          {"seed", "scene", "frames", "slam.profile", "mapper.method", "mapper.fusion.gain"}, ""),
      "trajectory handheld, fusion fixed");
  EXPECT_EQ(MeasuredSettings(Config::FromText("scene: den\nframes: 0\n", "run.yaml"), {}, ""),
            "den");
  EXPECT_EQ(MeasuredSettings(Config::FromText("scene: x/den.yaml\n", "run.yaml"), {}, "Lab 2"),
            "Lab 2");
}

class ProgramChanged : public ProgramTest {};

TEST_F(ProgramChanged, ARunsPageSaysWhatWasSet) {
  Succeed("run ./small.yaml --set mapper.grid.resolution_m=0.1 -o out");
  EXPECT_THAT(
      ReadFile(Path("out/report.html")),
      HasSubstr("\"changed\":\"sensor.width 80, sensor.height 60, mapper.grid.resolution_m 0.1\""));
  Succeed(
      "run ./small.yaml --set slam.profile=ground_truth --set slam.walk_translation_m=0.01 "
      "-o fitted");
  EXPECT_THAT(ReadFile(Path("fitted/report.html")),
              HasSubstr(", SLAM own settings over ground_truth, "));
  Write("one.log", "FLASER 3 2 2 2 1.5 -2 0.25 1.5 -2 0.25 10.5 host 10.5\n");
  Succeed("map one.log --set sequence.laser.max_range_m=20 -o mapped");
  EXPECT_THAT(ReadFile(Path("mapped/report.html")),
              HasSubstr("\"changed\":\"sequence.laser.max_range_m 20\""));
}

}  // namespace
}  // namespace depthgrid
