// What the report pages save as files: figures and tables.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "eval/sweep/sweep_database.h"
#include "tests/eval/report_page.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class SavedFigures : public ReportPage {
 protected:
  struct Saved {
    std::string name;
    std::string type;
    std::string text;  // of a picture in pixels: width x height, and how many colours
  };
  // What the button of that kind in the element saves.
  Saved Save(const std::string& selector, const std::string& kind) {
    browser_->Evaluate(
        "window.saved = null; saveFile = async (name, content, type) => { if (type === 'image/png')"
        " { const b = await createImageBitmap(content); const c = make('canvas', {width: b.width, "
        "height: b.height}); const x = c.getContext('2d'); x.drawImage(b, 0, 0); const d = new "
        "Uint32Array(x.getImageData(0, 0, b.width, b.height).data.buffer); content = "
        "`${b.width}x${b.height} ${new Set(d).size > 8 ? 'many' : 'few'}, corner ${d[0]}`; } "
        "window.saved = [name, type, content]; }");
    browser_->Evaluate("[...document.querySelectorAll('" + selector +
                       " .save button')].find((b) => b.textContent === '" + kind + "').click()");
    browser_->WaitFor("window.saved !== null");
    const auto saved = browser_->Evaluate("window.saved");
    return {saved[0], saved[1], saved[2]};
  }
  // Of the last picture saved: how many elements a selector finds in it; -1 where it is no SVG.
  int Count(const std::string& selector) {
    return browser_->Evaluate(
        "(() => { const d = new DOMParser().parseFromString(window.saved[2], 'image/svg+xml'); "
        "return d.querySelector('parsererror') ? -1 : d.querySelectorAll('" +
        selector + "').length; })()");
  }
};

constexpr const char* kWhitePixel = "4294967295";

// Two drift scales x three gains x six seeds, the error 1 cm x scale x (1 + |gain - 0.5|) + seed.
void MakeGainSweep(const std::string& folder) {
  std::vector<PlannedRun> plan;
  for (const char* scale : {"1", "2"}) {
    for (const char* gain : {"0", "0.5", "1"}) {
      for (const char* seed : {"1", "2", "3", "4", "5", "6"}) {
        const int run = static_cast<int>(plan.size());
        plan.push_back({run, run / 6, {scale, gain, seed}});
      }
    }
  }
  std::filesystem::create_directory(folder);
  SweepDatabase database =
      SweepDatabase::Create(folder, {{"title", "gains"}, {"experiment", "scene: living_room\n"}},
                            {"slam.drift_scale", "mapper.fusion.gain", "seed"}, plan);
  for (const PlannedRun& run : plan) {
    const double error =
        0.02 * std::stod(run.values[0]) * (1.0 + std::abs(std::stod(run.values[1]) - 0.5)) +
        0.001 * std::stod(run.values[2]);
    database.Record({run.run, "", {{"trajectory.est.mean_euclidean_m", error}}, {}});
  }
}

TEST_F(SavedFigures, OfASweep) {
  MakeGainSweep(Path("sweep"));
  Succeed("report sweep");
  browser_->Open(Path("sweep/report.html"));
  // The dark page's figure is that of paper.
  browser_->Evaluate("setTheme('dark')");
  const Saved plot = Save("#plot", "SVG");
  EXPECT_EQ(plot.name, "trajectory.est.mean_euclidean_along_mapper.fusion.gain.svg");
  EXPECT_EQ(plot.type, "image/svg+xml");
  EXPECT_THAT(plot.text, HasSubstr("#0072b2"));
  EXPECT_EQ(Count("circle"), 6);
  EXPECT_EQ(Count("g g > path"), 8);  // two lines, six whiskers
  EXPECT_THAT(plot.text, HasSubstr(">drift_scale 2</text>"));
  EXPECT_THAT(plot.text, HasSubstr(">cm</text>"));
  EXPECT_THAT(plot.text, HasSubstr("(living_room)"));  // what was measured
  EXPECT_EQ(browser_->Evaluate("document.documentElement.dataset.theme"), "dark");
  EXPECT_THAT(
      Save("#plot", "PNG").text,
      ::testing::AllOf(StartsWith("1920x"), HasSubstr("many, corner " + std::string(kWhitePixel))));
  EXPECT_THAT(Save("#plot", "CSV").text,
              StartsWith("mapper.fusion.gain,drift_scale 1 (cm),\"drift_scale 1, 95 % low (cm)\","
                         "\"drift_scale 1, 95 % high (cm)\",drift_scale 2 (cm)"));
  EXPECT_THAT(Save("#plot", "CSV").text, HasSubstr("\n0.5,2.35,"));
  // A line that is hidden is in no figure.
  browser_->Evaluate("document.querySelectorAll('#plot .u-legend .u-series th')[1].click()");
  Save("#plot", "SVG");
  EXPECT_EQ(Count("circle"), 3);

  EXPECT_THAT(
      Save("#heat-controls", "PNG").text,
      ::testing::AllOf(StartsWith("1920x"), HasSubstr("many, corner " + std::string(kWhitePixel))));
  const Saved heat = Save("#heat-controls", "SVG");
  EXPECT_EQ(Count("circle, parsererror"), 0);
  EXPECT_EQ(Count("g > rect[fill^=rgb]"), 2 * 3 + 160);
  EXPECT_THAT(heat.text, HasSubstr("trajectory.est.mean_euclidean (cm) over slam.drift_scale"));
  EXPECT_THAT(heat.text, HasSubstr("(living_room)"));
  EXPECT_THAT(heat.text, HasSubstr("Red: "));
  EXPECT_THAT(Save("#heat-controls", "CSV").text,
              HasSubstr("mapper.fusion.gain down, slam.drift_scale across\",1,2\n0,3.35,6.35\n"));
  const std::string best = Save("#best-note", "CSV").text;
  EXPECT_THAT(best, StartsWith("held,mapper.fusion.gain,mean (cm),95 % low (cm),95 % high (cm),"
                               "p (Holm),best in resamples,regret (cm),regret to,is best,"
                               "best 95 % low,best 95 % high,seeds\n"));
  EXPECT_THAT(best, HasSubstr("\ndrift_scale 1,0,3.35,"));
  EXPECT_THAT(
      best,
      HasSubstr(",,1,0,best value,1,0.5,0.5,6\n"));  // of 0.5, which is the best of every seed
  EXPECT_EQ(std::count(best.begin(), best.end(), '\n'), 7);
  const Saved table = Save("#table-note", "CSV");
  EXPECT_EQ(table.name, "gains_points.csv");
  EXPECT_THAT(table.text, StartsWith("slam.drift_scale,mapper.fusion.gain,runs,"
                                     "trajectory.est.mean_euclidean (cm),95 % low (cm)"));
  EXPECT_EQ(std::count(table.text.begin(), table.text.end(), '\n'), 7);
  EXPECT_THAT(browser_->problems(), IsEmpty());
}

TEST_F(SavedFigures, OfARun) {
  Succeed("run ./small.yaml -o out");
  browser_->Open(Path("out/report.html"));
  const Saved map = Save(".map-buttons", "SVG");
  EXPECT_EQ(map.name, "map.svg");
  EXPECT_EQ(Count("image"), 1);
  EXPECT_EQ(Count("svg svg > path"), 3);  // truth, SLAM, estimate
  EXPECT_THAT(map.text, HasSubstr(">Estimate at the end</text>"));
  EXPECT_THAT(map.text, HasSubstr(">1 m</text>"));
  // The key tells all that is shown: the layer, the chosen frame's scan and poses.
  for (const char* entry : {"occupied", "free", "unknown", "scan of frame ", "poses of frame "}) {
    EXPECT_THAT(map.text, HasSubstr(">" + std::string(entry)));
  }
  EXPECT_EQ(Count("svg svg > polygon"), 3);
  EXPECT_GT(Count("svg svg > rect"), 5);
  browser_->Evaluate("selectLayer('difference')");
  EXPECT_THAT(Save(".map-buttons", "SVG").text, HasSubstr(">wall, missed</text>"));
  EXPECT_THAT(Save(".map-buttons", "PNG").text, StartsWith("1920x"));
  Save("#plots .plot", "SVG");
  EXPECT_EQ(Count("g g > path"), 3);
  EXPECT_THAT(
      Save("#plots .plot", "CSV").text,
      StartsWith("time (s),SLAM (cm),estimate at the time (cm),estimate at the end (cm)\n"));
  // One gain of all axes hides none of the lines.
  EXPECT_EQ(browser_->Evaluate("[...document.querySelectorAll('.plot h3')].some((h) => "
                               "h.textContent.startsWith('Gain') && (h.parentElement.id = "
                               "'gain'))"),
            true);
  Save("#gain", "SVG");
  EXPECT_EQ(Count("g g > path[stroke-width=\"4.2\"], g g > path[stroke-width=\"1.6\"]"), 2);
  // Of the calibration: dots of so many cells, and a dashed line.
  Save("#numbers .plot", "SVG");
  EXPECT_EQ(Count("path[stroke-dasharray], line[stroke-dasharray]"), 2);
  EXPECT_EQ(Count("circle.key"), 1);
  EXPECT_THAT(Save("#numbers .plot", "CSV").text,
              StartsWith("probability in the map,truly occupied,cells,ideal\n"));
  EXPECT_THAT(browser_->problems(), IsEmpty());
}

TEST_F(SavedFigures, OfAStudy) {
  Write("study.yaml",
        "frames: 12\nscene: ./room.yaml\nsensor: {width: 80, height: 60}\nslam: {profile: "
        "orb_slam2}\ncases:\n"
        "  - {name: one, published_mean_m: 0.4}\n"
        "  - {name: two, mapper: {method: paper}}\n");
  Succeed("run ./study.yaml -o out");
  browser_->Open(Path("out/report.html"));
  const Saved maps = Save("#maps", "SVG");
  EXPECT_EQ(Count("image"), 5);  // the truth and two maps a case
  EXPECT_EQ(maps.name.substr(0, 5), "maps_");
  Save("#paths", "SVG");
  EXPECT_EQ(Count("polyline"), 6);
  EXPECT_EQ(browser_->Evaluate("/polyline[^>]*fill: none[^>]*stroke-width: 0.16/.test(saved[2])"),
            true);
  EXPECT_THAT(Save("#paths", "PNG").text, HasSubstr("many"));
  const Saved table = Save("#table-title", "CSV");
  EXPECT_THAT(table.text, StartsWith("Poses from,"));
  EXPECT_THAT(table.text, HasSubstr(" input aligned (m),"));
  EXPECT_THAT(Save("#map-table-title", "CSV").text,
              StartsWith("Case,input precision,input recall,input F1,input chamfer (mm),output "));
  EXPECT_THAT(browser_->problems(), IsEmpty());
}

}  // namespace
}  // namespace depthgrid
