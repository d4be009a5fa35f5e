// Tests of report pages: the program that writes them, and a browser that shows them.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/eval/browser.h"
#include "tests/eval/program.h"

namespace depthgrid {

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
    // Requested drawing happens in the next animation frame.
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
  // Expects that nothing extends beyond the right edge of a narrow screen.
  void ExpectFits() {
    EXPECT_LE(browser_->Evaluate("document.documentElement.scrollWidth - innerWidth").get<int>(),
              0);
  }

  std::optional<Browser> browser_;
};

}  // namespace depthgrid
