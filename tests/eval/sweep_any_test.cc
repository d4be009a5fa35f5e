// What a sweep's page says of the axes that a figure does not show, and how its marks stand.
#include <gmock/gmock.h>

#include "eval/sweep/sweep_database.h"
#include "tests/eval/report_page.h"

namespace depthgrid {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

// Three gains x two drift scales x two rooms' movers x two seeds.
class SweepAny : public ReportPage {
 protected:
  void SetUp() override {
    ReportPage::SetUp();
    if (!browser_) return;
    std::filesystem::create_directory(Path("sweep"));
    std::vector<PlannedRun> plan;
    for (const char* gain : {"0", "0.5", "1"}) {
      for (const char* scale : {"1", "2"}) {
        for (const char* movers : {"none", "walker"}) {
          for (const char* seed : {"1", "2"}) {
            const int run = static_cast<int>(plan.size());
            plan.push_back({run, run / 2, {gain, scale, movers, seed}});
          }
        }
      }
    }
    SweepDatabase database = SweepDatabase::Create(
        Path("sweep"), {{"title", "any"}, {"experiment", "scene: living_room\n"}},
        {"mapper.fusion.gain", "slam.drift_scale", "movers", "seed"}, plan);
    for (const PlannedRun& run : plan) {
      const double error_m = 0.002 + 0.0001 * run.run;
      database.Record({run.run,
                       "",
                       {{"trajectory.est.mean_euclidean_m", error_m},
                        {"trajectory.slam.mean_euclidean_m", 0.3}},
                       {}});
    }
    Succeed("report sweep");
    browser_->Open(Path("sweep/report.html"));
    browser_->Evaluate("along.held[2] = -1; heat.held[2] = -1; drawAlong(); drawHeat()");
  }
  // What the button below `place` saves.
  std::string SavedText(const std::string& place, const std::string& kind) {
    browser_->Evaluate(
        "window.got = ''; saveFile = (name, content) => { window.got = content; }; "
        "[...document.querySelectorAll('" +
        place + " .save button')].find((b) => b.textContent === '" + kind + "').click()");
    browser_->WaitFor("window.got !== ''");
    return browser_->Evaluate("window.got").get<std::string>();
  }
};

TEST_F(SweepAny, FiguresNameTheAxisThatIsNotHeld) {
  EXPECT_THAT(browser_->Evaluate("document.querySelector('#plot h3').firstChild.data"),
              EndsWith(" along mapper.fusion.gain, over all 2 values of movers"));
  const std::string dots =
      "Dots: mean over up to 2 seeds, one for each value of movers. Whiskers: "
      "bootstrap 95 % interval of the mean (";
  EXPECT_THAT(browser_->Evaluate("document.getElementById('plot-note').textContent"),
              StartsWith(dots));
  const auto flat = [](const std::string& svg) {  // lines are wrapped
    std::string text;
    bool inside = false;
    for (const char c : svg) {
      if (c == '<') inside = true;
      if (!inside) text += c;
      if (c == '>') inside = false, text += text.ends_with(' ') ? "" : " ";
    }
    return text;
  };
  EXPECT_THAT(flat(SavedText("#plot", "SVG")), HasSubstr(dots));
  EXPECT_THAT(flat(SavedText("#heat-controls", "SVG")), HasSubstr("over all 2 values of movers"));
  EXPECT_THAT(SavedText("#heat-controls", "CSV"), HasSubstr("over all 2 values of movers"));
  EXPECT_THAT(browser_->Evaluate("document.getElementById('heat-note').textContent"),
              HasSubstr("Means, over all 2 values of movers."));
  // Points of one x are told apart.
  const std::string csv = SavedText("#plot", "CSV");
  EXPECT_THAT(csv, StartsWith("mapper.fusion.gain,movers,"));
  EXPECT_THAT(csv, HasSubstr("\n0,none,"));
  EXPECT_THAT(csv, HasSubstr("\n0,walker,"));
  browser_->Evaluate("along.held[2] = 1; drawAlong()");
  EXPECT_THAT(SavedText("#plot", "CSV"), Not(HasSubstr("movers")));
  EXPECT_THAT(browser_->problems(), IsEmpty());
}

TEST_F(SweepAny, DotsStandOnTheirWhiskers) {
  SavedText("#plot", "SVG");
  browser_->Evaluate(
      "window.figure = new DOMParser().parseFromString(window.got, 'image/svg+xml'); "
      "window.dots = [...figure.querySelectorAll('circle:not(.key)')].map((c) => "
      "c.getAttribute('cx')); window.whiskers = [...figure.querySelectorAll('path')].map((p) => "
      "p.getAttribute('d').match(/^M([^,]*),[^V]*V[^M]*M[^h]*h6M/)?.[1]).filter(Boolean)");
  EXPECT_EQ(browser_->Evaluate("dots.length"), 12);
  EXPECT_EQ(browser_->Evaluate("whiskers.length > 0 && whiskers.every((x) => dots.includes(x))"),
            true);
  EXPECT_EQ(browser_->Evaluate("[0, 1].map((k) => asideOf([{low: []}, {low: []}], k)).join()"),
            "-1.5,1.5");
  EXPECT_EQ(browser_->Evaluate("asideOf([{}, {}], 1)"), 0);
}

TEST_F(SweepAny, ScoresOfOneQuantityHaveOneUnit) {
  EXPECT_EQ(browser_->Evaluate("new Set(METRICS.filter((m) => m.score.endsWith('euclidean_m'))"
                               ".map((m) => m.unit)).size"),
            1);
}

TEST_F(SweepAny, NumbersGiveWayToTheMarks) {
  EXPECT_EQ(browser_->Evaluate("[[0, 5, 20, 5], [0, 0, 20, 3], [12, -9, 12, 30], [0, 20, 20, 20]]"
                               ".map((mark) => crosses(mark, [10, 4, 30, 14])).join()"),
            "true,false,true,false");
  // Beside the mark in the cell's middle; above or below a line that passes there.
  EXPECT_EQ(browser_->Evaluate("(() => { const line = [-50, 17, 50, 17]; const places = "
                               "numberPlaces('12.7', 0, 0, 100, 34); return [places[0].y, "
                               "places.find((p) => !crosses(line, p.box)).y].join(); })()"),
            "21,12");
}

}  // namespace
}  // namespace depthgrid
