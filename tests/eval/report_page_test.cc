// The report pages of runs as a browser shows them.
#include "tests/eval/report_page.h"

#include <gmock/gmock.h>

#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

using ::testing::IsEmpty;

TEST_F(ReportPage, OfARun) {
  Succeed("run ./small.yaml -o out");
  browser_->Open(Path("out/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  ExpectEveryPlotIsDrawn();
  EXPECT_GT(ColoursOf("#map"), 5);
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#times .uplot').length"), 1);

  EXPECT_EQ(browser_->Evaluate("document.getElementById('changed').textContent"),
            "Not the default: sensor.width 80, sensor.height 60");
  EXPECT_EQ(browser_->Evaluate("document.querySelector('h1').textContent"), "test_room");

  // Ten worst frames, with the surface of those that were matched: all but the first.
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('.worst-card').length"), 10);
  EXPECT_GE(browser_->Evaluate("RUN.worst.filter((w) => w.surface).length").get<int>(), 9);
  EXPECT_GT(ColoursOf(".worst-card figure:nth-child(2) canvas"), 50);

  const std::string estimate = PixelsOf("#map");
  browser_->Click("#layer-difference");
  EXPECT_EQ(browser_->Evaluate("currentLayer"), "difference");
  EXPECT_NE(PixelsOf("#map"), estimate);
  browser_->Press("ArrowDown", 40);  // the layers are one group of radio buttons
  EXPECT_EQ(browser_->Evaluate("currentLayer"), "observable");

  // Beyond the pictures nothing could be seen; the scale bar has a strip of its own.
  browser_->Evaluate("selectLayer('difference'); zoomAt(0, 0, 0.5); drawMap()");
  const auto grey_at = [&](const char* y) {
    return browser_->Evaluate("canvas.getContext('2d').getImageData(canvas.width - 2, " +
                              std::string(y) + ", 1, 1).data[0]");
  };
  EXPECT_EQ(grey_at("mapHeight() - 2"), 0xe6);
  EXPECT_EQ(grey_at("canvas.height - 2"), 0xff);
  browser_->Evaluate("resetView()");

  browser_->Evaluate("document.getElementById('frame').focus()");
  browser_->Press("Home", 36);
  browser_->Press("ArrowRight", 39);
  EXPECT_EQ(browser_->Evaluate("currentFrame"), 1);
  browser_->Evaluate("document.querySelector('.plot').focus()");
  browser_->Press("ArrowRight", 39);
  EXPECT_EQ(browser_->Evaluate("currentFrame"), 2);
  browser_->Evaluate("document.getElementById('map').focus()");
  const std::string whole = PixelsOf("#map");
  browser_->Press("+");
  EXPECT_NE(PixelsOf("#map"), whole);
  browser_->Evaluate("window.dispatchEvent(new Event('resize'))");
  EXPECT_NE(PixelsOf("#map"), whole);  // what was zoomed to stays
  browser_->Press("0");
  EXPECT_EQ(PixelsOf("#map"), whole);

  // A zoom is that of all plots over time; other colours, and paper, leave it and hidden lines.
  browser_->Evaluate(
      "window.plots = () => allPlots.filter((p) => p.sync === 'frames').map((p) => p.state())");
  browser_->Evaluate("document.querySelector('#plots .u-legend tr:nth-child(2) th').click()");
  browser_->Evaluate("document.querySelector('.plot').focus()");
  browser_->Press("+");
  browser_->WaitFor("plots().every((p) => p.max - p.min < 0.75 * times.at(-1))");
  const nlohmann::json states = browser_->Evaluate("allPlots.map((p) => p.state())");
  EXPECT_EQ(states[0]["shown"][1], false);
  browser_->Click("#theme");
  EXPECT_EQ(browser_->Evaluate("document.documentElement.dataset.theme"), "dark");
  browser_->WaitFor("plots().every((p) => p.max !== null)");
  EXPECT_EQ(browser_->Evaluate("allPlots.map((p) => p.state())"), states);
  EXPECT_THAT(browser_->Evaluate("document.getElementById('numbers').textContent"),
              ::testing::AllOf(::testing::HasSubstr("heading, rmse, SE(2) aligned"),
                               ::testing::HasSubstr("rotation with tilt, mean, not aligned"),
                               ::testing::HasSubstr("log loss"), ::testing::HasSubstr("(MCC)")));
  ExpectEveryPlotIsDrawn();
  EXPECT_THAT(browser_->problems(), IsEmpty());
  browser_->Open(Path("out/report.html"), 400);
  ExpectFits();
}

// Such as another one that regrid drew.
// Also when the scene's file is gone.
TEST_F(ReportPage, IsHeadedByTheNameOfTheScene) {
  std::string scene = ReadFile(Path("room.yaml"));
  scene.replace(scene.find("test_room"), 9, "'My room: <1>'");
  Write("named.yaml", scene);
  Succeed("run ./small.yaml --set scene=./named.yaml -o named");
  std::filesystem::remove(Path("named.yaml"));
  Succeed("report named");
  EXPECT_THAT(ReadFile(Path("named/report.html")),
              ::testing::HasSubstr("<h1>My room: &lt;1></h1>"));
}

TEST_F(ReportPage, OfAMapThatIsAnotherByNowIsRefused) {
  Succeed("run ./small.yaml --set frames=3 -o made");
  const std::string map = ReadFile(Path("made/map.yaml"));
  const auto with = [&](const std::string& key, const std::string& value) {
    const std::size_t at = map.find(key);
    return map.substr(0, at) + key + value + map.substr(map.find('\n', at));
  };
  Write("made/map.yaml", with("resolution: ", "0.1"));
  ExpectRefusal("report made",
                {"made/map.yaml: resolution is 0.1, must be the 0.05 of made/truth_map"});
  Write("made/map.yaml", with("origin: ", "[1e6, 0, 0]"));
  ExpectRefusal("report made", {"made/map.yaml: its lower left corner (1e+06, 0) lies 10000"});
}

// What another frame saw is not shown for one whose place nobody knows.
TEST_F(ReportPage, OfFramesThatSlamLostNoScanIsShown) {
  Succeed(
      "run ./small.yaml -o out --set frames=60 --set slam.lost_rate_hz=3 --set "
      "slam.lost_mean_s=0.3");
  browser_->Open(Path("out/report.html"));
  const auto frames = [&](const char* lost, const char* without_scan) {
    const std::string path = "RUN.paths.est";
    return browser_
        ->Evaluate(path + ".x.filter((x, i) => (x === null) === " + lost + " && (scanNear(i, " +
                   path + ") === null) === " + without_scan + ").length")
        .get<int>();
  };
  EXPECT_GT(frames("true", "true"), 0);
  EXPECT_GT(frames("false", "false"), 0);
  EXPECT_EQ(frames("true", "false") + frames("false", "true"), 0);
  const auto panel = [&](const char* lost) {
    return browser_->Evaluate(
        "selectFrame(RUN.paths.est.x.findIndex((x) => (x === null) === " + std::string(lost) +
        ")), document.getElementById('frame-values').textContent");
  };
  EXPECT_THAT(panel("true"), ::testing::HasSubstr("no poseSLAM was lost"));
  EXPECT_THAT(panel("false"), ::testing::Not(::testing::HasSubstr("no pose")));
}

TEST_F(ReportPage, OfASequenceWithoutTruth) {
  Succeed("render ./small.yaml -o seq");
  Trajectory poses = ReadTrajectory(Path("seq/groundtruth.txt"));
  poses.erase(poses.begin() + 4, poses.begin() + 7);
  WriteTrajectory(Path("gap.txt"), poses);
  Succeed("map seq --poses gap.txt -o out");
  browser_->Open(Path("out/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  ExpectEveryPlotIsDrawn();
  // What has no pose is no frame that saw nothing and took no time.
  EXPECT_EQ(browser_->Evaluate("frames.beams.map((n) => n === null).join()"),
            browser_->Evaluate("RUN.paths.slam.x.map((x) => x === null).join()"));
  EXPECT_THAT(browser_->Evaluate("document.getElementById('headline').textContent"),
              ::testing::HasSubstr("3 of 12frames without a pose: SLAM was lost"));
  EXPECT_THAT(browser_->Evaluate("document.getElementById('times').textContent"),
              ::testing::HasSubstr("Without the 3 frames that have no pose"));
  EXPECT_EQ(browser_->Evaluate("whereMapped(RUN_TIMES.total_us).filter(isNumber).length"), 9);
  // One long frame hides none of the others.
  EXPECT_THAT(
      browser_->Evaluate("document.getElementById('times').textContent"),
      ::testing::AllOf(::testing::HasSubstr("mean µsmedian µs"), ::testing::HasSubstr("rest")));
  const char* axis =
      "(() => { const draw = drawPlot; let given; window.drawPlot = (box, what) => { given = what; "
      "}; initTimes(); window.drawPlot = draw; return `${given.logY} ${given.yLabel} "
      "${rangeFrom(given.leastY)(null, .2, 33411)}`; })()";
  EXPECT_EQ(browser_->Evaluate(axis), "true µs 1,100000");
  // Of a long run not every frame's scan is kept.
  EXPECT_THAT(browser_->Evaluate("document.getElementById('headline').textContent"),
              ::testing::HasSubstr("9frames mapped"));
  EXPECT_THAT(
      browser_->Evaluate(
          "(RUN.own_scans = 5, headline(), document.getElementById('headline').textContent)"),
      ::testing::HasSubstr("5scans kept, which the map is drawn from"));
  EXPECT_GT(ColoursOf("#map"), 3);
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#layers input').length"), 1);
  EXPECT_EQ(browser_->Evaluate("document.getElementById('numbers-section')"), nullptr);
}

// The finished map's scans are another run's: a frame of this one is never drawn with them.
TEST_F(ReportPage, OfARunInAFinishedMap) {
  Succeed("render ./small.yaml -o seq");
  const std::string map = "map seq --poses seq/groundtruth.txt --set mapper.fusion.mode=fixed ";
  Succeed(map + "-o first");
  Succeed(map + "--map first --localise -o placed");
  browser_->Open(Path("placed/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  EXPECT_EQ(browser_->Evaluate("RUN.scans.length"), 0);
  EXPECT_EQ(browser_->Evaluate("document.querySelector('.card').textContent"),
            "12 of 12frames placed in the finished map");
  EXPECT_EQ(browser_->Evaluate("document.getElementById('path-scan')"), nullptr);
  EXPECT_EQ(browser_->Evaluate("document.getElementById('worst-how').textContent.includes("
                               "'matched against the finished map')"),
            true);
  Succeed(map + "--map first -o longer");
  browser_->Open(Path("longer/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  EXPECT_EQ(browser_->Evaluate("RUN.scans.map((scan) => scan.row).join()"),
            "0,1,2,3,4,5,6,7,8,9,10,11");
  // SLAM's frame lies elsewhere: its path is shown where the run begins in the map.
  Trajectory moved = ReadTrajectory(Path("seq/groundtruth.txt"));
  for (StampedPose& pose : moved) pose.world_from_camera.translation.x() += 20.0;
  WriteTrajectory(Path("moved.txt"), moved);
  Succeed("map seq --poses moved.txt --map first -o elsewhere");
  browser_->Open(Path("elsewhere/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  EXPECT_EQ(browser_->Evaluate("Math.abs(RUN.paths.slam.x[0] - RUN.paths.est.x[0]) < 1e-6"), true);
  EXPECT_EQ(browser_->Evaluate("largestCorrection() < 0.5"), true);
  browser_->Open(Path("longer/report.html"));
  // What was there before the first frame is what that was matched against.
  EXPECT_EQ(browser_->Evaluate("RUN.worst.every((w) => w.surface)"), true);
}

}  // namespace
}  // namespace depthgrid
