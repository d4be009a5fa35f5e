// The report pages as a browser shows them.
#include <gmock/gmock.h>

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
  browser_->Press("0");
  EXPECT_EQ(PixelsOf("#map"), whole);

  browser_->Click("#theme");
  EXPECT_EQ(browser_->Evaluate("document.documentElement.dataset.theme"), "dark");
  ExpectEveryPlotIsDrawn();
  EXPECT_THAT(browser_->problems(), IsEmpty());
  browser_->Open(Path("out/report.html"), 400);
  ExpectFits();
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

}  // namespace
}  // namespace depthgrid
