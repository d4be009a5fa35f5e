// The report pages as a browser shows them.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "eval/sweep/sweep_database.h"
#include "mapper/io/trajectory_file.h"
#include "tests/eval/browser.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::IsEmpty;

class ReportPage : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const std::optional<std::string> chromium = FindChromium();
    if (!chromium) GTEST_SKIP() << "no chromium on this machine";
    browser_.emplace(*chromium, root_.string() + "_browser");
  }
  void TearDown() override {
    browser_.reset();
    ProgramTest::TearDown();
  }
  // How many colours an element's canvas shows: more than one once something is drawn on it.
  int ColoursOf(const std::string& selector) {
    return browser_->Evaluate("(() => { const c = document.querySelector('" + selector +
                              "'); const d = new Uint32Array(c.getContext('2d').getImageData(0, 0, "
                              "c.width, c.height).data.buffer); return new Set(d).size; })()");
  }
  // A canvas' pixels, to see that something changed them.
  std::string PixelsOf(const std::string& selector) {
    // What was asked to be drawn is drawn in the next animation frame.
    browser_->Evaluate(
        "window.drawn = false; requestAnimationFrame(() => requestAnimationFrame(() "
        "=> { window.drawn = true; }))");
    browser_->WaitFor("window.drawn");
    return browser_->Evaluate("document.querySelector('" + selector + "').toDataURL()");
  }
  void ExpectEveryPlotIsDrawn() {
    const int plots = browser_->Evaluate("document.querySelectorAll('.uplot canvas').length");
    EXPECT_GE(plots, 1);
    EXPECT_EQ(browser_->Evaluate(
                  "[...document.querySelectorAll('.uplot canvas')].filter((c) => new Set(new "
                  "Uint32Array(c.getContext('2d').getImageData(0, 0, c.width, "
                  "c.height).data.buffer)).size > 3).length"),
              plots);
  }
  // Nothing sticks out to the right of a narrow screen.
  void ExpectFits() {
    EXPECT_LE(browser_->Evaluate("document.documentElement.scrollWidth - innerWidth").get<int>(),
              0);
  }

  std::optional<Browser> browser_;
};

TEST_F(ReportPage, OfARun) {
  Succeed("run ./small.yaml -o out");
  browser_->Open(Path("out/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  ExpectEveryPlotIsDrawn();
  EXPECT_GT(ColoursOf("#map"), 5);
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#times .uplot').length"), 1);

  EXPECT_EQ(browser_->Evaluate("document.getElementById('changed').textContent"),
            "Not the default: sensor.width 80, sensor.height 60");

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

  browser_->Click("#theme");
  EXPECT_EQ(browser_->Evaluate("document.documentElement.dataset.theme"), "dark");
  ExpectEveryPlotIsDrawn();
  EXPECT_THAT(browser_->problems(), IsEmpty());
  browser_->Open(Path("out/report.html"), 400);
  ExpectFits();
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
}

TEST_F(ReportPage, OfASequenceWithoutTruth) {
  Succeed("render ./small.yaml -o seq");
  Succeed("map seq --poses seq/groundtruth.txt -o out");
  browser_->Open(Path("out/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  ExpectEveryPlotIsDrawn();
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

// Five gains x three noise scales x four seeds; one run failed.
void MakeSweep(const std::string& folder) {
  std::vector<PlannedRun> plan;
  for (const char* gain : {"0", "0.25", "0.5", "0.75", "1"}) {
    for (const char* scale : {"0.5", "1", "2"}) {
      for (const char* seed : {"1", "2", "3", "4"}) {
        const int run = static_cast<int>(plan.size());
        plan.push_back({run, run / 4, {gain, scale, seed}});
      }
    }
  }
  SweepDatabase database = SweepDatabase::Create(
      folder, {{"title", "gain_x_noise"}, {"experiment", "scene: living_room\n"}},
      {"mapper.fusion.gain", "slam.drift_scale", "seed"}, plan);
  for (const PlannedRun& run : plan) {
    if (run.run == 7) {
      database.Record({run.run, "lost", {}, {}});
      continue;
    }
    const double gain = std::stod(run.values[0]);
    const double scale = std::stod(run.values[1]);
    const double error =
        0.1 * scale * (1.0 - gain) + 0.05 * gain + 0.001 * std::stod(run.values[2]);
    database.Record({run.run,
                     "",
                     {{"trajectory.est.mean_euclidean_m", error},
                      {"map.observable.occupied.f1", 1.0 - error},
                      {"map.other_m", gain}},
                     {}});
  }
}

TEST_F(ReportPage, OfASweep) {
  std::filesystem::create_directory(Path("sweep"));
  MakeSweep(Path("sweep"));
  std::filesystem::create_directories(Path("sweep/runs/9"));
  Write("sweep/runs/9/report.html", "a run's page");
  Succeed("report sweep");
  browser_->Open(Path("sweep/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  ExpectEveryPlotIsDrawn();
  EXPECT_GT(ColoursOf("#heat canvas"), 20);
  EXPECT_EQ(browser_->Evaluate("metric.name"), "trajectory.est.mean_euclidean_m");
  // 60 runs, one failed; at half the noise no gain is best, at twice the noise all of it.
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#best tbody tr').length"), 3);
  EXPECT_EQ(browser_->Evaluate("document.querySelector('#best tbody tr:last-child td:nth-child(2)')"
                               ".textContent"),
            "1");

  // Values in centimetres are of no name that ends in metres.
  const std::string heads = browser_->Evaluate(
      "[...document.querySelectorAll('#table th button')].map((b) => "
      "b.textContent.replaceAll('\\u200b', '')).join('; ')");
  EXPECT_THAT(heads, ::testing::HasSubstr("trajectory.est.mean_euclidean (cm)"));
  EXPECT_THAT(heads, ::testing::Not(::testing::HasSubstr("_m (cm)")));
  EXPECT_THAT(browser_->Evaluate("document.getElementById('metric').textContent"),
              ::testing::Not(::testing::HasSubstr("_m (cm)")));

  const std::string means = PixelsOf("#plot canvas");
  const std::string heat = PixelsOf("#heat canvas");
  browser_->Evaluate("document.getElementById('metric').focus()");
  browser_->Press("ArrowDown", 40);
  EXPECT_EQ(browser_->Evaluate("metric.name"), "map.observable.occupied.f1");
  EXPECT_NE(PixelsOf("#plot canvas"), means);
  EXPECT_NE(PixelsOf("#heat canvas"), heat);
  browser_->Evaluate("document.querySelector('#heat canvas').focus()");
  browser_->Press("ArrowRight", 39);
  EXPECT_EQ(browser_->Evaluate("heat.cell[0]"), 1);

  browser_->Evaluate(
      "(() => { const s = document.getElementById('table-what'); s.value = 'runs'; "
      "s.dispatchEvent(new Event('change')); })()");
  const std::string first_cell = "document.querySelector('#table tbody td').textContent";
  EXPECT_EQ(browser_->Evaluate(first_cell), "0");
  browser_->Click("#table th button");
  EXPECT_EQ(browser_->Evaluate(first_cell), "59");
  browser_->Click("#table th input");
  for (const char* key : {"<", "1", "0"}) browser_->Press(key);
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#table tbody tr').length"), 10);
  EXPECT_EQ(browser_->Evaluate("document.querySelector('#table a').getAttribute('href')"),
            "runs/9/report.html");
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#table .failed').length"), 1);
  // Paper is narrower than the window.
  browser_->Evaluate("window.dispatchEvent(new Event('beforeprint'))");
  browser_->WaitFor("document.querySelector('#plot .uplot').clientWidth < 700");
  browser_->Evaluate("window.dispatchEvent(new Event('afterprint'))");
  browser_->WaitFor("document.querySelector('#plot .uplot').clientWidth > 700");
  browser_->Click("#table button.link");
  EXPECT_EQ(browser_->Evaluate("document.getElementById('table-command').textContent"),
            "depthgrid run experiment.yaml --set mapper.fusion.gain=0 --set slam.drift_scale=2 "
            "--set seed=1 -o runs/8");
  EXPECT_THAT(browser_->problems(), IsEmpty());
  browser_->Open(Path("sweep/report.html"), 400);
  ExpectFits();
}

// The command that a page shows, given in the sweep's folder, makes the very run: along presets,
// and with files that lie beside the experiment.
TEST_F(ReportPage, ItsCommandsRepeatTheRunsOfASweep) {
  std::filesystem::create_directory(Path("rooms"));
  Write("rooms/it's one.yaml", kRoom);
  Write("rooms/small.yaml", kExperiment);
  Write("rooms/room.yaml", kRoom);
  Write("sweep.yaml",
        "experiment: ./rooms/small.yaml\naxes: {scene: [./room.yaml, \"./it's one.yaml\"], "
        "slam.profile: [ground_truth, planar_slam], seed: [9007199254740993]}\n");
  Succeed("sweep ./sweep.yaml -o out");
  browser_->Open(Path("out/report.html"));
  const std::string error = "trajectory.slam.mean_euclidean_m";
  const std::vector<double> errors = ReadSweep(Path("out")).Metric(error);
  ASSERT_EQ(errors.size(), 4U);
  for (std::size_t row = 0; row < errors.size(); ++row) {
    std::string command = browser_->Evaluate("commandOf(" + std::to_string(row) + ")");
    ASSERT_TRUE(command.starts_with("depthgrid run experiment.yaml --set scene="));
    command = "cd '" + Path("out") + "' && '" + kProgramFile + "'" + command.substr(9);
    EXPECT_EQ(std::system((command + " >/dev/null").c_str()), 0) << command;
    const std::string folder = "out/runs/" + std::to_string(row);
    const auto metrics = nlohmann::json::parse(ReadFile(Path(folder + "/metrics.json")));
    EXPECT_EQ(metrics["trajectory"]["slam"]["mean_euclidean_m"], errors[row]) << command;
  }
  EXPECT_EQ(browser_->Evaluate("columnsOf('runs').find((c) => c.title === 'seed').text(0)"),
            "9007199254740993");
  // What should be 1 is judged by its distance from it.
  const auto better = [&](const std::string& metric) {
    return browser_->Evaluate("METRICS.find((m) => m.name === '" + metric + "').better");
  };
  EXPECT_EQ(better("trajectory.slam.sim3_scale"), "neither");
  EXPECT_EQ(better("|trajectory.slam.sim3_scale - 1|"), "lower");
  EXPECT_THAT(browser_->problems(), IsEmpty());
}

// What is held at first is a value at which there is something to see.
TEST_F(ReportPage, OfASweepWhoseFirstValueFails) {
  std::vector<PlannedRun> plan;
  for (const char* gain : {"0", "0.5", "1"}) {
    for (const char* scale : {"1", "2"}) {
      for (const char* range_m : {"0.3", "6"}) {
        const int run = static_cast<int>(plan.size());
        plan.push_back({run, run, {gain, scale, range_m}});
      }
    }
  }
  std::filesystem::create_directory(Path("sweep"));
  SweepDatabase database = SweepDatabase::Create(
      Path("sweep"), {{"title", "ranges"}, {"experiment", "scene: living_room\n"}},
      {"mapper.fusion.gain", "slam.drift_scale", "mapper.scan.max_range_m"}, plan);
  for (const PlannedRun& run : plan) {
    if (run.values[2] == "0.3") {
      database.Record({run.run, "too near", {}, {}});
    } else {
      database.Record({run.run, "", {{"trajectory.est.mean_euclidean_m", 0.01 * run.run}}, {}});
    }
  }
  Succeed("report sweep");
  browser_->Open(Path("sweep/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  ExpectEveryPlotIsDrawn();
  EXPECT_GT(ColoursOf("#heat canvas"), 3);
  // One reason, one line, with the setting that all six have.
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#failures tbody tr').length"), 1);
  EXPECT_EQ(browser_->Evaluate("document.querySelector('#failures tbody').textContent"),
            "6max_range_m 0.30, 2, 4, 6, 8, 10too near");
}

}  // namespace
}  // namespace depthgrid
