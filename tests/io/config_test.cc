#include "mapper/io/config.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "mapper/core/error.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

enum class Mode { kFixed, kKalman };

struct Inner {
  Mode mode = Mode::kFixed;
  std::array<double, 3> gain = {0.5, 0.5, 0.5};
  void Visit(OptionsVisitor& v) {
    v.Choice("mode", mode, {{Mode::kFixed, "fixed"}, {Mode::kKalman, "kalman"}},
             "who sets the gain");
    v.PerAxis("gain", gain, {0.0, 1.0}, "Kalman gain K");
  }
};

struct Outer {
  std::string scene;
  int frames = 900;
  std::uint64_t seed = 1;
  double step_m = 0.1;
  bool loops = true;
  std::vector<double> invalid = {0.0};
  Inner fusion;
  void Visit(OptionsVisitor& v) {
    v.Text("scene", scene, "what to render");
    v.Number("frames", frames, {1, 1e6}, "length");
    v.Seed("seed", seed, "random seed");
    v.Number("step_m", step_m, {0.0, 1.0}, "metres");
    v.Flag("loops", loops, "use loops");
    v.Numbers("invalid", invalid, {}, "values that mean no data");
    v.Group("fusion", fusion, "Eq. 3");
  }
};

std::string ConfigRefusal(const std::string& text) {
  Outer outer;
  return RefusalOf([&] { Config::FromText(text, "run.yaml").Read(outer); });
}

TEST(Config, ReadsEveryKind) {
  Outer outer;
  Config::FromText(
      "scene: room\nframes: 10\nseed: 18446744073709551615\nstep_m: 0.25\nloops: false\n"
      "invalid: [0, 65535]\nfusion: {mode: kalman, gain: [0.1, 0.2, 0.3]}\n",
      "x")
      .Read(outer);
  EXPECT_EQ(outer.scene, "room");
  EXPECT_EQ(outer.frames, 10);
  EXPECT_EQ(outer.seed, 18446744073709551615U);
  EXPECT_EQ(outer.step_m, 0.25);
  EXPECT_FALSE(outer.loops);
  EXPECT_EQ(outer.invalid, (std::vector<double>{0, 65535}));
  EXPECT_EQ(outer.fusion.mode, Mode::kKalman);
  EXPECT_EQ(outer.fusion.gain, (std::array<double, 3>{0.1, 0.2, 0.3}));
}

TEST(Config, OneNumberServesAllAxes) {
  Outer outer;
  Config::FromText("fusion: {gain: 0.25}", "x").Read(outer);
  EXPECT_EQ(outer.fusion.gain, (std::array<double, 3>{0.25, 0.25, 0.25}));
}

TEST(Config, WhatIsWrittenReadsBackTheSame) {
  Outer outer;
  outer.step_m = 0.1 + 0.2;
  outer.scene = "yes: [no";
  outer.fusion.gain = {0.1, 1.0 / 3.0, 0.3};
  Outer again;
  Config::FromText(ToYaml(outer), "x").Read(again);
  EXPECT_EQ(ToYaml(outer), ToYaml(again));
  EXPECT_EQ(again.step_m, outer.step_m);
  EXPECT_EQ(again.scene, outer.scene);
  EXPECT_EQ(again.fusion.gain, outer.fusion.gain);
}

TEST(Config, SetOverridesAndCreatesPaths) {
  Outer outer;
  Config config = Config::FromText("fusion: {gain: 0.25}", "x");
  config.Set("fusion.gain=0.75");
  config.Set("fusion.mode=kalman");
  config.Set("frames=5");
  config.Read(outer);
  EXPECT_EQ(outer.fusion.gain[0], 0.75);
  EXPECT_EQ(outer.fusion.mode, Mode::kKalman);
  EXPECT_EQ(outer.frames, 5);
}

std::string ErrorAfterSet(const std::string& assignment) {
  Config config = Config::FromText("frames: 10\nfusion: {mode: kalman}\n", "run.yaml");
  config.Set(assignment);
  Outer outer;
  return RefusalOf([&] { config.Read(outer); });
}

TEST(Config, ErrorsOfASetKeyNameTheAssignment) {
  EXPECT_EQ(ErrorAfterSet("fusion.gian=0.3"),
            "--set fusion.gian=0.3: unknown key 'fusion.gian', did you mean 'fusion.gain'?");
  EXPECT_EQ(ErrorAfterSet("fusion={gain: 2}"),
            "--set fusion={gain: 2}: fusion.gain is '2', must be from 0 to 1");
  EXPECT_THAT(ErrorAfterSet("frames=-1"), ::testing::StartsWith("--set frames=-1: frames is '-1'"));
}

// A key of the right word in the wrong group, or in none.
TEST(Config, AnUnknownKeyIsLookedForInEveryGroup) {
  EXPECT_EQ(ErrorAfterSet("gain=0.3"),
            "--set gain=0.3: unknown key 'gain', did you mean 'fusion.gain'?");
  EXPECT_EQ(ErrorAfterSet("fusion.seed=3"),
            "--set fusion.seed=3: unknown key 'fusion.seed', did you mean 'seed'?");
  EXPECT_EQ(ErrorAfterSet("matcher.weights.gian=3"),
            "--set matcher.weights.gian=3: unknown key 'matcher', did you mean 'fusion.gain'?");
  EXPECT_EQ(ErrorAfterSet("map.step=1"),
            "--set map.step=1: unknown key 'map', did you mean 'step_m'?");
  EXPECT_EQ(ErrorAfterSet("fuson.gain=1"),
            "--set fuson.gain=1: unknown key 'fuson', did you mean 'fusion'?");
  EXPECT_EQ(ErrorAfterSet("map={}"),
            "--set map={}: unknown key 'map', must be one of scene, frames, seed, step_m, loops, "
            "invalid, fusion");
}

// As a file that has a key twice is refused, also with one value.
TEST(Config, AKeyIsSetOnce) {
  const auto refusal = [](const std::vector<std::string>& assignments) {
    Config config = Config::FromText("frames: 10\nfusion: {mode: kalman}\n", "run.yaml");
    return RefusalOf([&] {
      for (const std::string& assignment : assignments) config.Set(assignment);
      const Config copy = config;  // has been given the same keys
      Config(copy).Set("step_m=0.2");
    });
  };
  EXPECT_EQ(refusal({"seed=1", "frames=2", "seed=2"}),
            "--set seed=2: key 'seed' is given twice, by --set seed=1 as well");
  EXPECT_EQ(refusal({"step_m=0.3"}),
            "--set step_m=0.2: key 'step_m' is given twice, by --set step_m=0.3 as well");
  EXPECT_EQ(refusal({"seed=1", "seed=1"}),
            "--set seed=1: key 'seed' is given twice, by --set seed=1 as well");
  EXPECT_EQ(refusal({"fusion.gain=0.1", "fusion={mode: fixed}"}),
            "--set fusion={mode: fixed}: key 'fusion' is given twice, by --set fusion.gain=0.1 as "
            "well");
  EXPECT_EQ(refusal({"fusion={mode: fixed}", "fusion.mode=kalman"}),
            "--set fusion.mode=kalman: key 'fusion.mode' is given twice, by --set fusion={mode: "
            "fixed} as well");
  EXPECT_EQ(refusal({"fusion={mode: fixed}", "fusion.gain=0.1", "fusions=1"}), "no error");
}

TEST(Config, APathWrittenAsAKeyIsToBeNested) {
  EXPECT_EQ(ConfigRefusal("frames: 3\nfusion.gain: 0.5\n"),
            "run.yaml:2: unknown key 'fusion.gain', write it as fusion: {gain: ...}");
}

TEST(Config, ADotThatNothingFollowsIsNoKey) {
  const auto refusal = [](const std::string& assignment) {
    Config config;
    return RefusalOf([&] { config.Set(assignment); });
  };
  for (const char* key : {"frames.", "fusion.gain.", ".frames", "fusion..gain", "."}) {
    EXPECT_EQ(refusal(std::string(key) + "=1"),
              fmt::format("--set {0}=1: '{0}' is no key: a name in it is empty", key));
  }
}

// A name that a user gave; elsewhere dots part the names of groups.
TEST(Config, ATopLevelKeyIsTakenDotsAndAll) {
  Config config =
      Config::FromText("a: {b: {gain: 0.1}}\na.b: {gain: 0.2}\na.c: [{gain: 0.3}]\n", "x");
  Inner inner;
  config.Take("a.b").Read(inner);
  EXPECT_EQ(inner.gain[0], 0.2);
  const auto maps = config.TakeMaps("a.c");
  ASSERT_EQ(maps.size(), 1U);
  maps[0].Read(inner);
  EXPECT_EQ(inner.gain[0], 0.3);
  EXPECT_THAT(config.Keys(), ::testing::ElementsAre("a"));
}

TEST(Config, SeveralKeysOfOneWordAreAllNamed) {
  const std::vector<std::string> keys = {"a.gain", "b.c.gain", "sensor.gain", "b.d.gain", "b.mode"};
  EXPECT_EQ(DidYouMeanKey("b.gain", keys, false),
            ", did you mean 'a.gain', 'b.c.gain' or 'b.d.gain'?");
  EXPECT_EQ(DidYouMeanKey("mod", keys, false), "");
  EXPECT_EQ(DidYouMeanKey("mod", keys, true), ", did you mean 'b.mode'?");
  EXPECT_EQ(DidYouMeanKey("weights", keys, true), "");
}

TEST(Config, ASubtreeStillKnowsWhatWasSet) {
  Config config = Config::FromText("fusion: {mode: kalman}\n", "run.yaml");
  config.Set("fusion.gain=7");
  Inner inner;
  try {
    config.Take("fusion").Read(inner);
    FAIL() << "a gain of 7 was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith("--set fusion.gain=7: fusion.gain is '7'"));
  }
}

TEST(Config, ErrorsOfASubtreeNameTheWholeKey) {
  const std::string text = "robot:\n  mapper:\n    rate: [1]\n    inner: {gian: 1}\n  list: 3\n";
  const auto refusal = [&](const std::function<void(Config&)>& read) {
    Config robot = Config::FromText(text, "run.yaml").Take("robot");
    return RefusalOf([&] { read(robot); });
  };
  const auto of_inner = [&](Config& robot) {
    Inner inner;
    robot.Take("mapper").Take("inner").Read(inner);
  };
  EXPECT_EQ(refusal(of_inner),
            "run.yaml:4: unknown key 'robot.mapper.inner.gian', did you mean "
            "'robot.mapper.inner.gain'?");
  EXPECT_EQ(refusal([](Config& robot) { robot.TakeMaps("list"); }),
            "run.yaml:5: 'robot.list' must be a list");
  EXPECT_EQ(refusal([](Config& robot) { robot.Take("list"); }),
            "run.yaml:5: 'robot.list' must be a map of keys");
  EXPECT_EQ(refusal([](Config& robot) { robot.Take("mapper").Text("rate"); }),
            "run.yaml:3: robot.mapper.rate is '[1]', must be a text");
  // What has a name of its own goes by that.
  EXPECT_EQ(refusal([](Config& robot) {
              Config mapper = robot.Take("mapper");
              mapper.NameSubject("mapper 'b'");
              mapper.Text("rate");
            }),
            "run.yaml:3: mapper 'b': rate is '[1]', must be a text");
}

TEST(Config, ACopyIsIndependent) {
  const Config original = Config::FromText("frames: 3", "x");
  Config copy = original;
  copy.Set("frames=4");
  Outer outer;
  original.Read(outer);
  EXPECT_EQ(outer.frames, 3);
}

TEST(Config, ErrorsOfACopyDoNotInventALine) {
  const Config original = Config::FromText("seed: 1\nframes: 0", "x");
  Outer outer;
  try {
    Config(original).Read(outer);
    FAIL() << "accepted 0 frames";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("x: frames is '0'"));
  }
}

// Where an experiment or a camera was asked for.
TEST(Config, LaserLogsAndTrajectoriesAreToldByTheirFirstRow) {
  const std::string log = "run.yaml: is a laser log, not YAML with keys; `depthgrid map` takes it";
  EXPECT_EQ(ConfigRefusal("# message_name ...: x\nPARAM robot_length 0.9 nohost 0\n"), log);
  EXPECT_EQ(ConfigRefusal("FLASER 3 1.0 1.0 1.0 0 0 0 0 0 0 1.5 host 1.5\n"), log);
  EXPECT_THAT(ConfigRefusal("# t x y z\n1.5 0 0 0 0 0 0 1\n"),
              HasSubstr("run.yaml: is a trajectory (rows of stamp x y z qx qy qz qw), not YAML"));
  EXPECT_THAT(ConfigRefusal("1 2 3\n4 5 6\n"), HasSubstr("is not YAML with keys"));
}

TEST(Config, ErrorsNameFileLineValueAndRule) {
  EXPECT_EQ(ConfigRefusal(""), "run.yaml: is empty");
  EXPECT_EQ(ConfigRefusal("- 1"), "run.yaml: is not YAML with keys, must be 'key: value' lines");
  EXPECT_EQ(ConfigRefusal("seed: 1\nframs: 3"),
            "run.yaml:2: unknown key 'frams', did you mean 'frames'?");
  EXPECT_EQ(ConfigRefusal("frams:\n  - 3"),
            "run.yaml:1: unknown key 'frams', did you mean 'frames'?");
  EXPECT_EQ(ConfigRefusal("fusion: {gian: 3}"),
            "run.yaml:1: unknown key 'fusion.gian', did you mean 'fusion.gain'?");
  EXPECT_EQ(ConfigRefusal("frames: 0"), "run.yaml:1: frames is '0', must be from 1 to 1000000");
  EXPECT_EQ(ConfigRefusal("frames: 1.5"), "run.yaml:1: frames is '1.5', must be a whole number");
  EXPECT_EQ(ConfigRefusal("step_m: .nan"), "run.yaml:1: step_m is '.nan', must be from 0 to 1");
  EXPECT_EQ(ConfigRefusal("seed: -1"),
            "run.yaml:1: seed is '-1', must be a whole number from 0 to 18446744073709551615");
  EXPECT_EQ(ConfigRefusal("scene: [a]"), "run.yaml:1: scene is '[a]', must be a text");
  EXPECT_EQ(ConfigRefusal("seed: 1\nseed: 2"), "run.yaml:2: key 'seed' is given twice");
  EXPECT_EQ(ConfigRefusal("fusion: {mode: kalmann}"),
            "run.yaml:1: fusion.mode is 'kalmann', must be one of fixed, kalman (did you mean "
            "'kalman'?)");
  EXPECT_EQ(ConfigRefusal("fusion: 3"), "run.yaml:1: fusion is '3', must be a map of keys");
  EXPECT_EQ(ConfigRefusal("fusion: {gain: [1, 1]}"),
            "run.yaml:1: fusion.gain is '[1, 1]', must be one number or [forward, left, yaw]");
  EXPECT_THAT(ConfigRefusal("a: [1"), HasSubstr("not valid YAML"));
}

// 010 is 8 to YAML 1.1 and 10 to YAML 1.2.
TEST(Config, WholeNumbersAreDecimalWithoutLeadingZeros) {
  EXPECT_EQ(ConfigRefusal("seed: 010"),
            "run.yaml:1: seed is '010', must be a decimal number without leading zeros");
  EXPECT_EQ(ConfigRefusal("frames: 010"),
            "run.yaml:1: frames is '010', must be a decimal number without leading zeros");
  EXPECT_EQ(ConfigRefusal("frames: -007"),
            "run.yaml:1: frames is '-007', must be a decimal number without leading zeros");
  EXPECT_EQ(ConfigRefusal("step_m: 00.5"),
            "run.yaml:1: step_m is '00.5', must be a decimal number without leading zeros");
  EXPECT_EQ(ConfigRefusal("frames: +10"), "no error");
  EXPECT_EQ(ConfigRefusal("frames: +-10"), "run.yaml:1: frames is '+-10', must be a whole number");
  EXPECT_EQ(ConfigRefusal("step_m: +-0.5"), "run.yaml:1: step_m is '+-0.5', must be a number");
  EXPECT_EQ(ConfigRefusal("frames: 0x10"), "run.yaml:1: frames is '0x10', must be a whole number");
  EXPECT_EQ(ConfigRefusal("frames: 99999999999"),
            "run.yaml:1: frames is '99999999999', must be a whole number");
  EXPECT_THAT(ConfigRefusal("seed: 18446744073709551616"), HasSubstr("must be a whole number"));
  EXPECT_EQ(ConfigRefusal("frames: +10\nseed: 0\nstep_m: 0.5"), "no error");
}

TEST(Config, ATextIsNeitherListNorMap) {
  const Config config = Config::FromText("a: 'it: is'\nb:\n  c: [x, y]\nd:\n", "run.yaml");
  EXPECT_EQ(config.Text("a"), "it: is");
  EXPECT_EQ(config.Text("z"), "");
  EXPECT_EQ(config.Text("z", "else"), "else");
  const auto refusal = [&](const char* key) { return RefusalOf([&] { config.Text(key); }); };
  EXPECT_EQ(refusal("b"), "run.yaml:3: b is '{c: [x, y]}', must be a text");
  EXPECT_EQ(refusal("b.c"), "run.yaml:3: b.c is '[x, y]', must be a text");
  const Config block = Config::FromText("a:\n  b: 1\n  c:\n    - 2\n    - {d: 3}\n", "run.yaml");
  EXPECT_EQ(RefusalOf([&] { block.Text("a"); }),
            "run.yaml:2: a is '{b: 1, c: [2, {d: 3}]}', must be a text");
  const Config lengthy = Config::FromText("a: [" + std::string(1000, 'x') + "]", "run.yaml");
  EXPECT_EQ(RefusalOf([&] { lengthy.Text("a"); }),
            "run.yaml:1: a is '[" + std::string(199, 'x') + "...', must be a text");
  EXPECT_EQ(refusal("d"), "run.yaml:4: d is empty, must be a text");
}

// yaml-cpp has what follows for the place of nothing.
TEST(Config, AKeyWithoutAValueIsNamedByItsOwnLine) {
  EXPECT_EQ(ConfigRefusal("frames:\nstep_m: 0.5"),
            "run.yaml:1: frames is empty, must be a whole number");
  EXPECT_EQ(ConfigRefusal("step_m: 0.5\nfusion:\n  gain:\n\n\nframes: 2"),
            "run.yaml:3: fusion.gain is empty, must be one number or [forward, left, yaw]");
}

TEST(Config, ListsOfMapsKeepTheirLines) {
  Config config = Config::FromText("frames: 2\nshapes:\n  - {mode: fixed}\n  - {mode: bad}\n", "x");
  const auto shapes = config.TakeMaps("shapes");
  ASSERT_EQ(shapes.size(), 2U);
  EXPECT_FALSE(config.Has("shapes"));
  EXPECT_EQ(shapes[1].Place(), "x:4");
  Inner inner;
  shapes[0].Read(inner);
  EXPECT_THROW(shapes[1].Read(inner), InputError);
  EXPECT_TRUE(config.TakeMaps("absent").empty());
}

struct Geometry {
  std::array<double, 3> at = {0, 0, 0};
  std::vector<double> outline = {1, 2};
  void Visit(OptionsVisitor& v) {
    v.Tuple("at", at, {-10, 10}, "a point");
    v.Rows("outline", outline, 2, {}, "corners");
  }
};

TEST(Config, ReadsTuplesAndRows) {
  Geometry geometry;
  Config::FromText("at: [1, 2, 3]\noutline: [[0, 0.5], [1, 0]]", "x").Read(geometry);
  EXPECT_EQ(geometry.at, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(geometry.outline, (std::vector<double>{0, 0.5, 1, 0}));
  EXPECT_EQ(ToYaml(geometry), "at: [1, 2, 3]\noutline: [[0, 0.5], [1, 0]]\n");

  const auto error_of = [](const std::string& text) {
    Geometry target;
    return RefusalOf([&] { Config::FromText(text, "x").Read(target); });
  };
  EXPECT_EQ(error_of("at: [1, 2]"), "x:1: at is '[1, 2]', must be a list of 3 numbers");
  EXPECT_EQ(error_of("at: [1, 2, 11]"), "x:1: at is '11', must be from -10 to 10");
  EXPECT_EQ(error_of("outline: [[1, 2], [3]]"),
            "x:1: outline is '[3]', must be a list of 2 numbers");
  EXPECT_EQ(error_of("outline: 3"), "x:1: outline is '3', must be a list of lists of 2 numbers");
}

TEST(NearestWord, FindsSmallSlipsOnly) {
  EXPECT_EQ(NearestWord("gian", {"mode", "gain"}), "gain");
  EXPECT_EQ(NearestWord("zzz", {"mode", "gain"}), "");
  EXPECT_EQ(NearestWord("rnu", {"map", "run"}), "run");
  EXPECT_EQ(NearestWord("frams", {"frame_rate", "frames"}), "frames");
  EXPECT_EQ(NearestWord("", {"mode"}), "");
  EXPECT_EQ(NearestWord(std::string(101, 'a'), {std::string(100, 'a')}), "");  // no slip
  EXPECT_EQ(NearestWord("--out", {"--set", "--output"}), "--output");
  EXPECT_EQ(NearestWord("--f", {"--frames", "--frame-rate"}), "");
  EXPECT_EQ(DidYouMean("gian", {"mode", "gain"}, "fusion."), ", did you mean 'fusion.gain'?");
  EXPECT_EQ(DidYouMean("zzz", {"mode", "gain"}), "");
}

}  // namespace
}  // namespace depthgrid
