// The report pages of sweeps as a browser shows them.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "eval/sweep/sweep_database.h"
#include "tests/eval/report_page.h"

namespace depthgrid {
namespace {

using ::testing::IsEmpty;

class SweepPage : public ReportPage {};

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

TEST_F(SweepPage, OfASweep) {
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
  EXPECT_EQ(browser_->Evaluate("plotSeries([]).series.filter((s) => s.onlyPoints).length"), 0);
  EXPECT_EQ(browser_->Evaluate("document.getElementById('of').textContent"), "living_room");
  EXPECT_EQ(browser_->Evaluate(
                "['a.drift_m_per_s', 'a.drift_m_per_m'].map((m) => suitedUnit(m, [0.003, 0.02, "
                "0.05])).map(({label, unit}) => `${label} ${unit}`).join()"),
            "a.drift cm/s,a.drift cm/m");
  EXPECT_EQ(browser_->Evaluate("suitedUnit('a.drift_m_per_s', [0.003]).unit"), "mm/s");
  EXPECT_EQ(browser_->Evaluate("[10897, 9108.3, 0.123456, 1234567, -2345678.4, 1.23456e20].map("
                               "compact).join()"),
            "10897,9108,0.1235,1234567,-2345678,123500000000000000000");
  // The best of a column is marked in its middle, where its value is.
  EXPECT_EQ(browser_->Evaluate(
                "(() => { let at; drawBestMarks = (context, best, u) => { at = u; }; const p = "
                "heatPainting(heatCells([]), [], 1000, true); p.paint(new SvgContext()); const "
                "half = (at(1) - at(0)) / 2; return [0, 1].every((c) => p.cellAt(at(c) - 0.99 * "
                "half, 50)[0] === c && p.cellAt(at(c) + 0.99 * half, 50)[0] === c); })()"),
            true);
  // 60 runs, one failed; at half the noise no gain is best, at twice the noise all of it.
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#best tbody tr').length"), 3);
  EXPECT_EQ(browser_->Evaluate("document.querySelector('#best tbody tr:last-child td:nth-child(2)')"
                               ".textContent"),
            "1");
  // Of the seeds of the failed run the other values of its line are left out too.
  EXPECT_EQ(browser_->Evaluate("document.getElementById('best-note').textContent.includes('only "
                               "the seeds that all have are compared')"),
            true);

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
  // A number is found as it is shown, too.
  EXPECT_EQ(browser_->Evaluate("['3.162', '<3.1622', '3.16'].map((text) => matcher(text, "
                               "true)(3.16228, '3.162')).join()"),
            "true,false,false");
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
TEST_F(SweepPage, ItsCommandsRepeatTheRunsOfASweep) {
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
  // Two files of one room.
  EXPECT_EQ(browser_->Evaluate("SWEEP.axes[0].names.join()"), "test_room,test_room");
  EXPECT_EQ(browser_->Evaluate("AXES[0].labels.join()"), "room.yaml,it's one.yaml");
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

// Seeds make no other points: there is one, no axis to draw along, and every run of it.
TEST_F(SweepPage, OfASweepOverSeedsAlone) {
  Write("seeds.yaml", "experiment: ./small.yaml\naxes: {seed: {seeds: 3}}\n");
  Succeed("sweep ./seeds.yaml -o out");
  browser_->Open(Path("out/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  EXPECT_EQ(browser_->Evaluate("document.getElementById('subtitle').textContent"),
            "3 runs: 3 seeds");
  EXPECT_THAT(browser_->Evaluate("document.getElementById('of').textContent"),
              ::testing::StartsWith("test_room, 12 frames"));  // the name, not the file's
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#headline .card').length"), 2);
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#plot, #best, #heat').length"), 0);
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#table tbody tr').length"), 1);
  browser_->Evaluate("chooseMetric('map.observable.occupied.f1')");
  browser_->Evaluate(
      "(() => { const s = document.getElementById('table-what'); s.value = 'runs'; "
      "s.dispatchEvent(new Event('change')); })()");
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#table tbody tr').length"), 3);
  EXPECT_THAT(browser_->problems(), IsEmpty());
}

// What changes together is no two axes to hold against each other.
TEST_F(SweepPage, OfASweepWithKeysThatChangeTogether) {
  std::vector<PlannedRun> plan;
  const std::vector<std::vector<std::string>> systems = {
      {"orb_slam2", "48.4"}, {"planar_slam", "37.5"}, {"planar_slam_mh", "35.2"}};
  for (const auto& system : systems) {
    for (const char* mode : {"fixed", "kalman"}) {
      const int run = static_cast<int>(plan.size());
      plan.push_back({run, run, {system[0], system[1], mode}});
    }
  }
  std::filesystem::create_directory(Path("sweep"));
  SweepDatabase database = SweepDatabase::Create(
      Path("sweep"), {{"title", "systems"}, {"experiment", "scene: living_room\n"}},
      {"slam.profile", "slam.drift_scale", "mapper.fusion.mode"}, plan);
  for (const PlannedRun& run : plan) {
    database.Record({run.run, "", {{"trajectory.est.mean_euclidean_m", 0.01 * run.run}}, {}});
  }
  Succeed("report sweep");
  browser_->Open(Path("sweep/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  EXPECT_EQ(browser_->Evaluate("[along.axis, along.by, heat.y, heat.x].map((i) => "
                               "shortKey(AXES[i].key)).join()"),
            "drift_scale,mode,drift_scale,mode");
  // No line joins systems that differ in more than their drift.
  EXPECT_EQ(browser_->Evaluate("plotSeries([]).series.filter((s) => s.onlyPoints).length"), 2);
  EXPECT_EQ(browser_->Evaluate("heatCells([]).flat().filter((cell) => cell).length"), 6);
}

TEST_F(SweepPage, LongNamesAreShortened) {
  std::filesystem::create_directory(Path("sweep"));
  SweepDatabase database = SweepDatabase::Create(
      Path("sweep"), {{"title", "rooms"}}, {"scene", "mapper.fusion.mode"},
      {{0, 0, {"./some/folder/den.yaml", "fixed"}}, {1, 1, {"living_room", "kalman"}}});
  for (const int run : {0, 1}) {
    database.Record({run, "", {{"trajectory.est.mean_euclidean_m", 0.01}}, {}});
  }
  Succeed("report sweep");
  browser_->Open(Path("sweep/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  EXPECT_EQ(browser_->Evaluate("AXES[0].labels.join()"), "den,living_room");
  const std::string unlike = R"({key: "scene", texts: ["a/den.yaml", "b/den.yaml"]})";
  EXPECT_EQ(browser_->Evaluate("nameLabels(" + unlike + ").join()"), "a/den.yaml,b/den.yaml");
  const std::string absolute = R"({key: "scene", texts: ["/x/a/den.yaml", "/x/b/den.yaml"]})";
  EXPECT_EQ(browser_->Evaluate("nameLabels(" + absolute + ").join()"), "a/den.yaml,b/den.yaml");
  const std::string named = R"({key: "scene", texts: ["a/den.yaml", "b"], names: ["lab", ""]})";
  EXPECT_EQ(browser_->Evaluate("nameLabels(" + named + ").join()"), "lab,b");
  EXPECT_EQ(browser_->Evaluate("shortened('planar_slam_measured', 9)"), "plan…ured");
  EXPECT_EQ(browser_->Evaluate("shortened('orb_slam2', 9)"), "orb_slam2");
}

TEST_F(SweepPage, LogarithmicAxesAreLabelledWhereTheyAreShort) {
  std::filesystem::create_directory(Path("sweep"));
  MakeSweep(Path("sweep"));
  Succeed("report sweep");
  browser_->Open(Path("sweep/report.html"));
  const auto ticks = [&](const std::string& arguments) {
    return browser_->Evaluate("logTicks(" + arguments + ").join()");
  };
  EXPECT_EQ(ticks("[1, 2, 3, 5], 0.97, 5.2"), "1,1.5,2,3,4,5");
  EXPECT_EQ(ticks("[0.1, 1, 10], 0.09, 11"), "0.1,0.2,0.5,1,2,5,10");
  EXPECT_EQ(ticks("[0.1, 1000], 0.09, 1100"), "0.1,1,10,100,1000");
  EXPECT_EQ(ticks("[110, 120, 120, 130], 109, 131"), "110,120,130");
  // No two ticks of a linear axis have one label.
  const auto labels = [&](const std::string& arguments) {
    return browser_->Evaluate("linearLabels(null, " + arguments + ").join()");
  };
  EXPECT_EQ(labels("[0.003, 0.0035, 0.004], 1, 30, 0.0005"), "0.0030,0.0035,0.0040");
  EXPECT_EQ(labels("[0.99995, 1, 1.00005], 1, 30, 0.00005"), "0.99995,1.00000,1.00005");
  EXPECT_EQ(labels("[9000, 9500, 10000], 1, 30, 500"), "9000,9500,10000");
}

// Nothing random: one measurement, made four times, has no interval.
TEST_F(SweepPage, SeedsThatRepeatOneAnotherCountOnce) {
  std::vector<PlannedRun> plan;
  for (const char* gain : {"0", "1"}) {
    for (const char* seed : {"1", "2", "3", "4"}) {
      const int run = static_cast<int>(plan.size());
      plan.push_back({run, run / 4, {gain, seed}});
    }
  }
  std::filesystem::create_directory(Path("sweep"));
  SweepDatabase database = SweepDatabase::Create(
      Path("sweep"), {{"title", "exact"}, {"experiment", "scene: living_room\n"}},
      {"mapper.fusion.gain", "seed"}, plan);
  for (const PlannedRun& run : plan) {
    database.Record({run.run, "", {{"trajectory.est.mean_euclidean_m", 0.1 + run.point}}, {}});
  }
  Succeed("report sweep");
  browser_->Open(Path("sweep/report.html"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
  EXPECT_EQ(browser_->Evaluate("metric.low.concat(metric.high).filter(isNumber).length"), 0);
  EXPECT_EQ(
      browser_->Evaluate("document.getElementById('plot-note').textContent.trim()"),
      "Dots: mean over one seed. A seed with the same scores as another one, as where nothing is "
      "random, counts once: 6 of 8 runs are such repeats.");
  EXPECT_EQ(browser_->Evaluate("document.querySelector('#best tbody').textContent"),
            "all0––10one seed tells nothing–1");
}

// What is held at first is a value at which there is something to see.
TEST_F(SweepPage, OfASweepWhoseFirstValueFails) {
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
  EXPECT_THAT(browser_->Evaluate("document.querySelector('#plot h3').firstChild.data"),
              ::testing::EndsWith(" along mapper.fusion.gain, at max_range_m 6"));
  // One reason, one line, with the setting that all six have.
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#failures tbody tr').length"), 1);
  EXPECT_EQ(browser_->Evaluate("document.querySelector('#failures tbody').textContent"),
            "6max_range_m 0.30, 2, 4, 6, 8, 10too near");
  // There is no best gain at the range that fails, and none of the two ranges: the page says so.
  const std::string missing = "document.getElementById('best-missing').textContent";
  const std::string too_few =
      "No best value where fewer than two values have a figure (see Failed runs): ";
  EXPECT_EQ(
      browser_->Evaluate(missing),
      too_few + "none (drift_scale 1, max_range_m 0.3), none (drift_scale 2, max_range_m 0.3).");
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('#best tbody tr').length"), 2);
  EXPECT_EQ(browser_->Evaluate("whyNoLines({key: 'scene', texts: ['a', 'b'], numeric: false})"),
            "No best value: those of scene are no numbers; the means above compare them.");
  EXPECT_EQ(browser_->Evaluate("whyNoLines({key: 'frames', texts: ['5'], numeric: true})"), "");
  EXPECT_EQ(browser_->Evaluate("[4e-16, -4e-16, 0.25].map((v) => METRICS[0].shown(v) === 0)"),
            nlohmann::json({true, true, false}));
  browser_->Evaluate("along.axis = 2; drawAlong()");
  EXPECT_THAT(browser_->Evaluate(missing),
              ::testing::StartsWith(too_few + "only 6 (gain 0, drift_scale 1), only 6"));
  EXPECT_EQ(browser_->Evaluate("document.getElementById('best-section').hidden"), false);
  // Points 0 and 2 failed; a score that 1 lacks has no value there.
  EXPECT_EQ(browser_->Evaluate("whyMissing([0, 2])"), " (see Failed runs)");
  EXPECT_EQ(browser_->Evaluate("whyMissing([1])"),
            " (no run failed: the score has no value there)");
}

}  // namespace
}  // namespace depthgrid
