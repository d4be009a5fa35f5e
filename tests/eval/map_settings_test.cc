// `depthgrid map`: what the keys of a map's run.yaml mean as settings.
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

class MapSettingsTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Write("one.log", "FLASER 3 2 2 2 1.5 -2 0.25 1.5 -2 0.25 10.5 host 10.5\n");
  }
};

TEST_F(MapSettingsTest, LocalisingNeedsAMap) {
  Succeed("map one.log -o m");
  ExpectRefusal("map m/run.yaml --set localise=true -o out",
                {"--set localise=true: localise is true, must be false without a map to localise "
                 "in (--map DIR)"});
  std::string yaml = ReadFile(Path("m/run.yaml"));
  const std::string off = "localise: false";
  yaml.replace(yaml.find(off), off.size(), "localise: true");
  Write("mine.yaml", yaml);
  ExpectRefusal("map mine.yaml -o out", {"mine.yaml:", "localise is true, must be false"});
}

TEST_F(MapSettingsTest, AStartIsThreeNumbersInAMap) {
  Succeed("map one.log -o m");
  for (const std::string start : {"1,2", "1,2,3,4", "1,2,x", "1,nan,3", "1,2,", "''"}) {
    ExpectRefusal("map one.log --map m -o out --start " + start,
                  {"must be three finite numbers: X,Y,YAW_DEG"});
  }
  ExpectRefusal("map one.log -o out --start 1,2,3",
                {"--start 1,2,3: start is '1,2,3', must be empty without a map to begin in"});
  ExpectRefusal("map one.log --map m --set start=1,2,3 -o out", {"--start X,Y,YAW_DEG"});
  ExpectRefusal("map one.log --map m -o out --start-within 0.3",
                {"--start-within 0.3: is how far off --start may be: give --start X,Y,YAW_DEG"});
  ExpectRefusal("map one.log --map m -o out --start 1,2,3 --start-within -1",
                {"--start-within -1", "start_within_m is '-1', must be from 0 to 5"});
  std::string yaml = ReadFile(Path("m/run.yaml"));
  const std::string none = "start: \"\"";
  yaml.replace(yaml.find(none), none.size(), "start: 1,2");
  Write("mine.yaml", yaml);
  ExpectRefusal("map mine.yaml --map m -o out", {"mine.yaml:", "start is '1,2', must be three"});
}

TEST_F(MapSettingsTest, AMapThatIsNotDrawnHasNoMode) {
  Succeed("map one.log -o m");
  ExpectRefusal("map one.log --map m --localise --map-mode raw -o out",
                {"--map-mode raw: is for a map that is drawn"});
}

TEST_F(MapSettingsTest, WhatHasAnOptionIsNoSettingOfAPlainInput) {
  ExpectRefusal("map one.log --set poses=slam.txt -o out",
                {"--set poses=slam.txt: is for a map's run.yaml as input; give --poses FILE"});
  ExpectRefusal("map one.log --set map=m -o out", {"--set map=m: ", "give --map DIR"});
  ExpectRefusal("map one.log --set input=two.log -o out", {"--set input=two.log: "});
  ExpectRefusal("map one.log --set localise=true -o out", {"give --map DIR --localise"});
  Succeed("map one.log -o m");
  Write("two.log", ReadFile(Path("one.log")));
  Succeed("map m/run.yaml --set input=two.log -o again");
}

TEST_F(MapSettingsTest, ASettingThatDoesNotFitIsNamedWithWhereItWasSet) {
  Succeed("render ./small.yaml --no-colour -o seq");
  const std::string key = "sequence.recording.";
  ExpectRefusal(
      "map seq -o out2 --set " + key + "depth_scale=0.001",
      {"depthgrid: --set " + key + "depth_scale=0.001: " + key + "depth_scale is 0.001, "});
  ExpectRefusal(
      "map seq -o out2 --set " + key + "invalid_units=[0.5]",
      {"depthgrid: --set " + key + "invalid_units=[0.5]: " + key + "invalid_units holds"});
  ExpectRefusal("map seq -o out2 --set mapper.fusion.mode=oracle",
                {"depthgrid: --set mapper.fusion.mode=oracle: mapper.fusion.mode is oracle, must"});
  Succeed("map seq -o made");
  std::string settings = ReadFile(Path("made/run.yaml"));
  const std::string from = "from_s: 0";
  settings.replace(settings.find(from), from.size(), "from_s: 99");
  Write("late.yaml", settings);
  ExpectRefusal("map late.yaml -o out2",
                {"depthgrid: late.yaml:", ": sequence.from_s is 99, must"});
}

}  // namespace
}  // namespace depthgrid
