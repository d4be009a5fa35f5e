// Several experiments side by side: `depthgrid run` of a file with cases.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/eval/browser.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kStudy = R"(
title: Two and one
frames: 6
sensor: {width: 80, height: 60, noise: handa}
mapper: {method: paper, fusion: {mode: fixed, gain: 0.5}}
cases:
  - {name: orb, scene: ./room.yaml, slam: {profile: orb_slam2}, published_mean_m: 0.407}
  - {name: other_seed, scene: ./room.yaml, slam: {profile: planar_slam}, depth_seed: 9}
  - {name: truth, scene: ./room.yaml, slam: {profile: ground_truth}}
notes:
  - {title: Rooms, text: are not the same.}
)";

class StudyRun : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Write("study.yaml", kStudy);
  }
};

// Cases that share their images run together; nothing of that shows.
TEST_F(StudyRun, EachCaseIsWhatItWouldBeAlone) {
  Succeed("run ./study.yaml -o out --threads 2");
  for (const char* name : {"orb", "other_seed", "truth"}) {
    const std::string folder = std::string("out/") + name;
    Succeed("run " + folder + "/run.yaml -o alone_" + name + " --threads 1");
    // What a study's case has beyond a run.
    for (const char* more : {"input_map.yaml", "input_map.pgm"}) {
      EXPECT_TRUE(std::filesystem::remove(Path(folder + "/" + more)));
    }
    ExpectSameBytes(folder, std::string("alone_") + name);
  }
}

TEST_F(StudyRun, EachCaseHasTheWarningsThatItWouldHaveAlone) {
  Write("lost.yaml", R"(
frames: 90
seed: 5
sensor: {width: 80, height: 60}
cases:
  - {name: lost, scene: ./room.yaml, slam: {profile: orb_slam2, lost_rate_hz: 3}}
  - {name: truth, scene: ./room.yaml, slam: {profile: ground_truth}}
)");
  Succeed("run ./lost.yaml -o out");
  Succeed("run out/lost/run.yaml -o alone");
  const std::string warnings = ReadFile(Path("alone/warnings.txt"));
  EXPECT_THAT(warnings, HasSubstr("SLAM was lost before frame"));
  EXPECT_EQ(ReadFile(Path("out/lost/warnings.txt")), warnings);
  EXPECT_EQ(ReadFile(Path("out/truth/warnings.txt")), "");
}

// They took the same time, though one was written after the other.
TEST_F(StudyRun, CasesThatRunTogetherHaveTheSameTimes) {
  Succeed("run ./study.yaml -o out");
  const auto total = [&](const std::string& name, const char* key) {
    return nlohmann::json::parse(ReadFile(Path("out/" + name + "/timing.json")))[key].get<double>();
  };
  for (const char* key : {"wall_s_total", "cpu_s_total"}) {
    EXPECT_EQ(total("orb", key), total("truth", key)) << key;
    EXPECT_GT(total("orb", key), 0.0) << key;
  }
}

TEST_F(StudyRun, ThePageShowsWhatTheCommandLineChanged) {
  const std::string note = "published errors are those of the study as it is written";
  EXPECT_THAT(Program("run ./study.yaml -o as_written").out, Not(HasSubstr(note)));
  EXPECT_THAT(ReadFile(Path("as_written/report.html")), HasSubstr("\"overrides\":[]"));
  EXPECT_THAT(Program("run ./study.yaml -o out --set frames=4 --set seed=2").out,
              HasSubstr(note + ", without frames=4, seed=2\n"));
  const std::string shown = "\"overrides\":[\"frames=4\",\"seed=2\"]";
  EXPECT_THAT(ReadFile(Path("out/report.html")), HasSubstr(shown));
  Succeed("report out");
  EXPECT_THAT(ReadFile(Path("out/report.html")), HasSubstr(shown));
}

// A paper's tables and figures are the paper's study's alone.
TEST_F(StudyRun, ThePageSaysWhatTheCasesDifferInAndCallsItsPartsAsAsked) {
  Succeed("run ./study.yaml -o out");
  const std::string page = ReadFile(Path("out/report.html"));
  EXPECT_THAT(page, HasSubstr("\"differences\":[{\"key\":\"depth_seed\",\"values\":[\"0\",\"9\","
                              "\"0\"]}]"));
  for (const char* of_paper : {"Table 1", "Fig. 3", "Fig. 4", "the paper"}) {
    EXPECT_THAT(page, testing::Not(HasSubstr(of_paper)));
  }
  Write("study.yaml", std::string(kStudy) + "headings: {table: 'Table 2: errors'}\n");
  Succeed("run ./study.yaml -o named");
  EXPECT_THAT(ReadFile(Path("named/report.html")), HasSubstr("\"table\":\"Table 2: errors\""));
}

TEST_F(StudyRun, PutsScoresAndPublishedFiguresTogether) {
  Succeed("run ./study.yaml -o out");
  const auto metrics = nlohmann::json::parse(ReadFile(Path("out/metrics.json")));
  ASSERT_EQ(metrics["cases"].size(), 3U);
  EXPECT_EQ(metrics["cases"]["orb"]["published_mean_m"], 0.407);
  EXPECT_EQ(metrics["cases"]["truth"]["published_mean_m"], nullptr);
  const auto alone = nlohmann::json::parse(ReadFile(Path("out/orb/metrics.json")));
  EXPECT_EQ(metrics["cases"]["orb"]["trajectory"], alone["trajectory"]);
  EXPECT_EQ(metrics["cases"]["orb"]["map"], alone["map"]);
  // The poses that came in make a map of their own, and true ones make it true.
  EXPECT_GT(metrics["cases"]["truth"]["input_map"]["observable"]["occupied"]["f1"], 0.9);
  EXPECT_FALSE(SameFile("out/orb/input_map.pgm", "out/truth/input_map.pgm"));
  const Outcome again = Program("run ./study.yaml -o again --threads 1");
  EXPECT_THAT(again.out, HasSubstr("other_seed"));
  const double mean_m = alone["trajectory"]["est"]["mean_euclidean_m"];
  EXPECT_THAT(again.out, HasSubstr(fmt::format("  {:.4f}  ", mean_m)));
  EXPECT_THAT(again.out, HasSubstr("look at again/report.html"));
  EXPECT_EQ(again.err, "");
  ExpectSameBytes("out", "again");
}

TEST_F(StudyRun, OverridesHoldForEveryCase) {
  const std::string more = " --set frames=5 --set mapper.fusion.gain=0.25";
  EXPECT_EQ(Program("run ./study.yaml -o out" + more).err, "");
  for (const char* name : {"orb", "other_seed", "truth"}) {
    const std::string settings = ReadFile(Path(std::string("out/") + name + "/run.yaml"));
    EXPECT_THAT(settings, HasSubstr("frames: 5"));
    EXPECT_THAT(settings, HasSubstr("gain: 0.25"));
  }
}

TEST_F(StudyRun, MapsOfEveryCaseHaveTheModeAskedFor) {
  Succeed("run ./study.yaml -o out --map-mode scale --set frames=2");
  for (const char* name : {"orb", "other_seed", "truth"}) {
    for (const char* map : {"map", "input_map"}) {
      const std::string path = std::string("out/") + name + "/" + map;
      EXPECT_THAT(ReadFile(Path(path + ".yaml")), HasSubstr("mode: scale"));
      EXPECT_TRUE(std::filesystem::exists(Path(path + ".scale.png")));
    }
  }
  Succeed("run ./study.yaml -o out --force --set frames=2");
  for (const char* map : {"map", "input_map"}) {
    EXPECT_TRUE(std::filesystem::exists(Path(std::string("out/orb/") + map + ".pgm")));
    EXPECT_FALSE(std::filesystem::exists(Path(std::string("out/orb/") + map + ".scale.png")));
  }
}

TEST_F(StudyRun, WhatIsWrongWithACaseIsSaidWithItsName) {
  const std::string err = Program("run ./study.yaml -o out --set sensor.max_range_m=0.1").err;
  for (const std::string name : {"orb", "other_seed", "truth"}) {
    const std::string line = ReadFile(Path("out/" + name + "/warnings.txt"));
    EXPECT_THAT(line, HasSubstr("hold no measurement"));
    EXPECT_THAT(err, HasSubstr("depthgrid: warning: case " + name + ": " + line));
  }
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 3);
}

TEST_F(StudyRun, CasesThatBecameTheSameAreSaid) {
  EXPECT_EQ(Program("run ./study.yaml -o out --set slam.profile=ground_truth").err,
            "depthgrid: warning: case truth: is the same as case orb\n");
}

TEST_F(StudyRun, ACameraThatIsHardlyMeantIsSaidOnce) {
  EXPECT_EQ(
      Program("run ./study.yaml -o out --set sensor.fx=70").err,
      "depthgrid: warning: case orb: sensor.fx is 70 and fy 60, of which only fx was set: set "
      "both\n");
}

TEST_F(StudyRun, ReportWritesTheSamePageAgain) {
  Succeed("run ./study.yaml -o out");
  const std::string page = ReadFile(Path("out/report.html"));
  std::filesystem::remove(Path("out/report.html"));
  Succeed("report out");
  EXPECT_EQ(Difference(ReadFile(Path("out/report.html")), page), "");
}

TEST_F(StudyRun, RefusesWhatMakesNoSense) {
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::string& says) {
    std::string text = kStudy;
    text.replace(text.find(from), from.size(), to);
    Write("wrong.yaml", text);
    const Outcome outcome = Program("run ./wrong.yaml -o out");
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(says));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
    EXPECT_FALSE(std::filesystem::exists(Path("out")));
  };
  refused("profile: ground_truth", "profile: ground_trth", "wrong.yaml:9");
  refused("name: truth", "name: orb", "wrong.yaml:9: name 'orb' is given twice");
  refused("name: truth", "name: ../truth", "wrong.yaml:9: name of a case is '../truth'");
  refused("name: truth, ", "", "must be of letters");
  refused("frames: 6", "framse: 6", "'framse'");
  refused("text: are", "txet: are", "'txet'");
  refused("  - {name: truth, scene: ./room.yaml,", "  - {name: truth,", "'scene' is missing");
  Write("no_cases.yaml", "cases: []\n");
  EXPECT_THAT(Program("run ./no_cases.yaml -o out").err, HasSubstr("'cases'"));
  for (const char* command :
       {"render ./study.yaml -o out", "slam-calibrate ./study.yaml --target 1"}) {
    const Outcome outcome = Program(command);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  }
}

TEST_F(StudyRun, ThePageShowsEveryCase) {
  const std::optional<std::string> chromium = FindChromium();
  if (!chromium) GTEST_SKIP() << "no chromium on this machine";
  Succeed("run ./study.yaml -o out");
  Browser browser(*chromium, root_.string() + "_browser");
  browser.Open(Path("out/report.html"));
  EXPECT_THAT(browser.problems(), IsEmpty());
  // The truth, and two maps a case, all of them loaded.
  EXPECT_EQ(browser.Evaluate("[...document.images].filter((i) => i.naturalWidth > 9).length"), 7);
  EXPECT_EQ(browser.Evaluate("document.querySelectorAll('#paths polyline').length"), 9);
  EXPECT_EQ(browser.Evaluate("document.querySelectorAll('#table tbody tr').length"), 3);
  EXPECT_THAT(browser.Evaluate("document.getElementById('table').innerText").get<std::string>(),
              HasSubstr("0.407"));
  // The keys have the colours of the lines in the dark theme too;
  // the room has one scale bar below its true map.
  EXPECT_EQ(
      browser.Evaluate("setTheme('dark'); [...document.querySelectorAll('.paths-legend i')].every("
                       "(key) => getComputedStyle(key).backgroundColor === getComputedStyle("
                       "document.querySelector(`polyline.${key.dataset.path}`)).stroke)"),
      true);
  EXPECT_EQ(browser.Evaluate("document.querySelectorAll('#maps .bar').length"), 1);
  EXPECT_THAT(
      browser.Evaluate("document.getElementById('differences').innerText").get<std::string>(),
      HasSubstr("depth_seed: 0 (orb, truth), 9 (other_seed)."));
  browser.Open(Path("out/report.html"), 400);
  EXPECT_LE(browser.Evaluate("document.documentElement.scrollWidth - innerWidth").get<int>(), 0);
}

// The page compares what the cases did, not how their file puts it.
TEST_F(StudyRun, ThePageListsNoDifferenceThatHasNoEffect) {
  std::string room = kRoom;
  room +=
      "  pause:\n    kind: handheld\n    waypoints:\n"
      "      - {at: [1.5, 1.0, 1.1], look_at: [1.5, 4.0, 1.0]}\n"
      "      - {at: [1.6, 1.2, 1.1], look_at: [1.5, 4.0, 1.0]}\n";
  Write("room.yaml", room);
  const std::string head = "scene: ./room.yaml\nsensor: {width: 80, height: 60}\ncases:\n";
  Write("named.yaml", "frames: 6\n" + head +
                          "  - {name: a, trajectory: look_around, depth_seed: 1}\n"
                          "  - {name: b}\n");
  Succeed("run ./named.yaml -o named");
  EXPECT_THAT(ReadFile(Path("named/report.html")), HasSubstr("\"differences\":[]"));
  Write("three.yaml", "frames: 6\n" + head +
                          "  - {name: a, trajectory: look_around}\n  - {name: b}\n"
                          "  - {name: c, trajectory: pause}\n");
  Succeed("run ./three.yaml -o three");
  EXPECT_THAT(ReadFile(Path("three/report.html")),
              HasSubstr("\"differences\":[{\"key\":\"trajectory\",\"values\":[\"look_around\","
                        "\"look_around\",\"pause\"]}]"));
  Write("two.yaml", "frames: 6\n" + head + "  - {name: a}\n  - {name: b, trajectory: pause}\n");
  Succeed("run ./two.yaml -o two");
  EXPECT_THAT(ReadFile(Path("two/report.html")), HasSubstr("\"values\":[\"default\",\"pause\"]"));
}

// Cases that differ in something else than the poses: none is left out, each has its own path, and
// maps in other cells are held beside each other only.
TEST_F(StudyRun, ThePageTellsCasesOfOneRoomApart) {
  const std::optional<std::string> chromium = FindChromium();
  if (!chromium) GTEST_SKIP() << "no chromium on this machine";
  std::filesystem::create_directory(Path("other"));
  Write("other/room.yaml", kRoom);
  Write("alike.yaml", R"(
frames: 6
scene: ./room.yaml
sensor: {width: 80, height: 60}
cases:
  - {name: half, mapper: {fusion: {mode: fixed, gain: 0.5}}}
  - {name: one, frames: 9, mapper: {fusion: {mode: fixed, gain: 1}}}
  - {name: fine, mapper: {grid: {resolution_m: 0.02}}}
  - {name: elsewhere, scene: ./other/room.yaml}
)");
  Succeed("run ./alike.yaml -o out");
  Browser browser(*chromium, root_.string() + "_browser");
  browser.Open(Path("out/report.html"));
  EXPECT_THAT(browser.problems(), IsEmpty());
  const std::string table = browser.Evaluate(
      "[...document.querySelectorAll('#table tbody tr')].map((r) => r.cells[0].innerText).join()");
  EXPECT_EQ(table, "Ground truth (half),Ground truth (one),Ground truth");
  const std::string rooms = browser.Evaluate("STUDY.rooms.map((room) => room.scene).join()");
  EXPECT_EQ(rooms,
            "test_room (room.yaml), cells of 0.05 m,test_room (room.yaml), cells of 0.02 m,"
            "test_room (other/room.yaml)");
  EXPECT_EQ(browser.Evaluate("document.querySelector('h1').textContent"), "Study of test_room");
  EXPECT_EQ(browser.Evaluate("STUDY.cases.map((c) => c.true_path.length / 2).join()"), "6,9,6,6");
  EXPECT_EQ(browser.Evaluate("document.querySelector('#paths figcaption').textContent"),
            "Ground truth (half)");
}

}  // namespace
}  // namespace depthgrid
