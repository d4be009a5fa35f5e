#include "mapper/grid/submap.h"

#include <gtest/gtest.h>

#include "mapper/paper_reference.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

// The n-th scan hits the cell (n, 0) alone.
ScanCells MarkOf(int n) {
  ScanCells cells;
  cells.hit.Reset({n, 0}, {n, 0});
  cells.passed = cells.hit;
  cells.hit.Set({n, 0});
  return cells;
}

// Which scans the submap that is matched against holds.
std::pair<int, int> RangeOf(ActiveSubmaps& submaps, int count) {
  int first = -1, last = -1;
  for (int n = 0; n < count; ++n) {
    if (std::isnan(submaps.matching()->map().At({n, 0}))) continue;
    if (first < 0) first = n;
    last = n;
  }
  return {first, last};
}

TEST(ActiveSubmaps, TheOlderOfTwoIsMatchedAgainst) {
  ActiveSubmaps submaps({.scans = 10}, {});
  EXPECT_EQ(submaps.matching(), nullptr);
  for (int n = 0; n < 45; ++n) {
    submaps.Insert(MarkOf(n), {}, {});
    // Scans 0-19 are matched against submap 0, 20-29 against submap 1 (scans 10-29), and so on.
    const int first = n < 20 ? 0 : (n / 10 - 1) * 10;
    EXPECT_EQ(RangeOf(submaps, 45), std::make_pair(first, n)) << n;
  }
}

// Cells may be so small that one scan alone covers more of them than a submap has elsewhere.
TEST(ActiveSubmaps, AScanOfMoreCellsThanUsualBeginsNoneAnew) {
  ActiveSubmaps submaps({.scans = 10}, {});
  for (int n = 0; n < 3; ++n) {
    ScanCells cells;
    cells.hit.Reset({0, 0}, {8300, 8300});
    cells.passed = cells.hit;
    cells.hit.Set({n, 0});
    submaps.Insert(cells, {}, {});
  }
  EXPECT_EQ(RangeOf(submaps, 5), std::make_pair(0, 2));
}

TEST(ActiveSubmaps, RestartsWhereAnyScanIs) {
  for (const int count : {7, 10, 25, 30}) {
    ActiveSubmaps running({.scans = 10}, {});
    for (int n = 0; n < count; ++n) running.Insert(MarkOf(n), {}, {});
    ActiveSubmaps restarted({.scans = 10}, {});
    const int first = std::max((count - 1) / 10 - 1, 0) * 10;
    restarted.RestartAt(first);
    for (int n = first; n < count; ++n) restarted.Insert(MarkOf(n), {}, {});
    for (int n = count; n < count + 25; ++n) {
      EXPECT_EQ(RangeOf(running, 60), RangeOf(restarted, 60)) << count << " " << n;
      running.Insert(MarkOf(n), {}, {});
      restarted.Insert(MarkOf(n), {}, {});
    }
  }
}

TEST(PaperReference, RebuildingAtTheSamePosesChangesNothing) {
  const PlanarWorld room = RectangleWorld(-2.45, -2.5, 2.45, 2.5);
  PaperReference running({}, {.scans = 10}, {}, {});
  PaperReference rebuilt({}, {.scans = 10}, {}, {});
  ScanArchive archive;
  std::vector<MappedFrame> frames;
  for (int i = 0; i < 35; ++i) {
    MappedFrame frame;
    frame.map_from_base = {0.02 * i, 0.0, 0.03 * i};
    const auto scan =
        std::make_shared<const Scan>(ScanOf(room, frame.map_from_base, {.beams = 200}));
    frame.scan = archive.Keep(*scan);
    running.Insert(scan, frame.map_from_base, {});
    rebuilt.Insert(scan, frame.map_from_base, {});
    frames.push_back(frame);
  }
  rebuilt.Rebuild(frames);
  const auto scan = std::make_shared<const Scan>(ScanOf(room, {0.7, 0.0, 1.05}, {.beams = 200}));
  const Prediction predicted{.map_from_base = {0.72, 0.02, 1.06}};
  const MatchResult a = running.Match(scan, predicted);
  const MatchResult b = rebuilt.Match(scan, predicted);
  ASSERT_TRUE(a.found);
  EXPECT_EQ(a.map_from_base, b.map_from_base);
  EXPECT_EQ(a.score, b.score);
  EXPECT_EQ(a.information, b.information);
}

}  // namespace
}  // namespace depthgrid
