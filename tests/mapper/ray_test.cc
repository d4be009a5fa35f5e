#include "mapper/grid/ray.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

using CellSet = std::set<std::pair<int, int>>;  // x, y

CellSet SegmentCells(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  CellSet cells;
  VisitSegmentSpans(from, to, [&](const CellSpan& span) {
    EXPECT_LE(span.first_x, span.last_x);
    for (int x = span.first_x; x <= span.last_x; ++x) {
      EXPECT_TRUE(cells.emplace(x, span.y).second) << "visited twice";
    }
  });
  return cells;
}

// Independent of rows: cuts the segment at every grid line and takes the cell of each piece's
// middle, and the cells of the two end points.
CellSet BruteForceCells(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  std::vector<double> cuts = {0.0, 1.0};
  for (int axis = 0; axis < 2; ++axis) {
    const auto [low, high] = std::minmax(from[axis], to[axis]);
    for (double line = std::ceil(low); line <= high; line += 1.0) {
      if (from[axis] != to[axis]) cuts.push_back((line - from[axis]) / (to[axis] - from[axis]));
    }
  }
  std::sort(cuts.begin(), cuts.end());
  CellSet cells;
  const auto add = [&](const Eigen::Vector2d& p) {
    cells.emplace(FloorToInt(p.x()), FloorToInt(p.y()));
  };
  add(from);
  add(to);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if (cuts[i] - cuts[i - 1] > 1e-12) add(from + 0.5 * (cuts[i] + cuts[i - 1]) * (to - from));
  }
  return cells;
}

void ExpectBothWays(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const CellSet& expected) {
  EXPECT_EQ(SegmentCells(a, b), expected);
  EXPECT_EQ(SegmentCells(b, a), expected);
}

TEST(SegmentSpans, ByHandInBothDirections) {
  ExpectBothWays({0.5, 0.5}, {0.5, 0.5}, {{0, 0}});                          // a point
  ExpectBothWays({0.5, 0.5}, {2.5, 0.5}, {{0, 0}, {1, 0}, {2, 0}});          // along a row
  ExpectBothWays({0.5, -1.5}, {0.5, 0.5}, {{0, -2}, {0, -1}, {0, 0}});       // a column
  ExpectBothWays({0.5, 0.5}, {2.5, 1.5}, {{0, 0}, {1, 0}, {1, 1}, {2, 1}});  // slope 1/2
  ExpectBothWays({0.5, 1.5}, {2.5, 0.5}, {{0, 1}, {1, 1}, {1, 0}, {2, 0}});  // slope -1/2
  // Through corners: straight to the diagonal neighbour, whatever the slope.
  ExpectBothWays({0.5, 0.5}, {2.5, 2.5}, {{0, 0}, {1, 1}, {2, 2}});
  ExpectBothWays({0.5, 2.5}, {2.5, 0.5}, {{0, 2}, {1, 1}, {2, 0}});
  // On grid lines: the half-open cell that holds them.
  ExpectBothWays({0.0, 0.5}, {2.0, 0.5}, {{0, 0}, {1, 0}, {2, 0}});
  ExpectBothWays({1.0, 0.5}, {1.0, 2.5}, {{1, 0}, {1, 1}, {1, 2}});
  ExpectBothWays({0.5, 1.0}, {2.5, 1.0}, {{0, 1}, {1, 1}, {2, 1}});
}

TEST(SegmentSpans, AgreeWithBruteForceSupercover) {
  RandomStream random(1, RandomStage::kTest);
  int cases = 0;
  for (const double length : {0.3, 3.0, 100.0}) {
    for (int i = 0; i < 2000; ++i, ++cases) {
      const Eigen::Vector2d from(random.Uniform(-20, 20), random.Uniform(-20, 20));
      const double angle = random.Uniform(0, 2 * kPi);
      const Eigen::Vector2d to = from + length * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      ASSERT_EQ(SegmentCells(from, to), BruteForceCells(from, to)) << from << "\n" << to;
      ASSERT_EQ(SegmentCells(to, from), BruteForceCells(from, to)) << from << "\n" << to;
    }
  }
  EXPECT_EQ(cases, 6000);
}

// Across a boundary by less than a double's slope can tell.
TEST(SegmentSpans, AlongABoundaryOfRowsAreInOneRow) {
  const Eigen::Vector2d from(0.5, -1e-310), to(3.5, 1e-310);
  const std::vector<CellSpan> expected = {{0, 0, 3}};
  for (const auto& [a, b] : {std::pair(from, to), std::pair(to, from)}) {
    std::vector<CellSpan> spans;
    VisitSegmentSpans(a, b, [&](const CellSpan& span) { spans.push_back(span); });
    EXPECT_EQ(spans, expected);
  }
}

// Ends on multiples of a quarter meet corners and grid lines all the time, and are exact.
TEST(SegmentSpans, AgreeWithBruteForceOnGridLines) {
  int cases = 0;
  for (int x = -12; x <= 12; ++x) {
    for (int y = -12; y <= 12; ++y) {
      for (int phase = 0; phase < 16; ++phase, ++cases) {
        const Eigen::Vector2d from(0.25 * (phase % 4), 0.25 * (phase / 4));
        const Eigen::Vector2d to = from + Eigen::Vector2d(0.25 * x, 0.25 * y);
        ASSERT_EQ(SegmentCells(from, to), BruteForceCells(from, to)) << from << "\n" << to;
      }
    }
  }
  EXPECT_EQ(cases, 10000);
}

}  // namespace
}  // namespace depthgrid
