#include "eval/metrics/map_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "eval/metrics/distance_transform.h"
#include "mapper/core/rng.h"
#include "tests/metrics/drawn_map.h"

namespace depthgrid {
namespace {

StateMap Drawn(const std::vector<std::string>& rows, const Cell& min_cell = {}) {
  return DrawnMap(rows, 0.1, min_cell);
}

CellSet MaskDrawn(const std::vector<std::string>& rows, Cell min_cell = {}) {
  return CellsIn(Drawn(rows, min_cell), CellState::kOccupied);
}

CellSet RandomMask(RandomStream& random) {
  const GridGeometry geometry{0.05,
                              {-3, 7},
                              1 + static_cast<int>(random.Below(14)),
                              1 + static_cast<int>(random.Below(14))};
  CellSet mask(geometry);
  const double density = random.Uniform() * random.Uniform();
  for (auto& member : mask.members) member = random.Uniform() < density;
  return mask;
}

TEST(SquaredDistances, AgreesWithBruteForce) {
  RandomStream random(7, RandomStage::kTest);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const CellSet mask = RandomMask(random);
    const auto fast = SquaredDistances(mask);
    for (std::size_t p = 0; p < mask.members.size(); ++p, ++compared) {
      const Cell a = mask.geometry.CellAt(p);
      double best = INFINITY;
      for (std::size_t q = 0; q < mask.members.size(); ++q) {
        const Cell b = mask.geometry.CellAt(q);
        if (mask.members[q] != 0)
          best = std::min(best, std::pow(a.x - b.x, 2) + std::pow(a.y - b.y, 2));
      }
      ASSERT_EQ(fast[p], best);
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST(Grown, AgreesWithBruteForce) {
  RandomStream random(8, RandomStage::kTest);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const CellSet mask = RandomMask(random);
    const int radius = static_cast<int>(random.Below(4));
    const CellSet grown = Grown(mask, radius);
    for (std::size_t p = 0; p < mask.members.size(); ++p, ++compared) {
      const Cell a = mask.geometry.CellAt(p);
      bool near = false;
      for (int dx = -radius; dx <= radius; ++dx) {
        for (int dy = -radius; dy <= radius; ++dy) near = near || mask.Has({a.x + dx, a.y + dy});
      }
      ASSERT_EQ(grown.members[p] != 0, near);
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST(ScoreMap, APerfectMapScoresOne) {
  const StateMap truth = Drawn({"####", "#..#", "####"});
  const MapScore score = ScoreMap(truth, truth, MaskDrawn({"####", "####", "####"}));
  for (const CellScores& scores : {score.all, *score.observable}) {
    for (const StateScore& state : {scores.occupied[0], scores.occupied[2], scores.free[1]}) {
      EXPECT_EQ(state.precision, 1.0);
      EXPECT_EQ(state.recall, 1.0);
      EXPECT_EQ(state.f1, 1.0);
      EXPECT_EQ(state.iou, 1.0);
    }
    EXPECT_EQ(scores.chamfer_m, 0.0);
    EXPECT_EQ(scores.hausdorff95_m, 0.0);
    EXPECT_EQ(scores.coverage, 1.0);
  }
  EXPECT_EQ(score.all.confusion[2][2], 10);
  EXPECT_EQ(score.all.confusion[1][1], 2);
}

// A wall of five cells; the estimate has three of them, one cell beside it, and one far away.
TEST(ScoreMap, ToleranceByHand) {
  const StateMap truth = Drawn({"......", "......", "......", "#####."});
  const StateMap estimate = Drawn({"....#.", "......", "...#..", "###..."});
  const CellScores all = ScoreMap(truth, estimate, std::nullopt).all;
  EXPECT_EQ(all.occupied[0].precision, 3.0 / 5);
  EXPECT_EQ(all.occupied[0].recall, 3.0 / 5);
  EXPECT_DOUBLE_EQ(*all.occupied[0].iou, 3.0 / 7);  // 3 in both, 7 in either
  EXPECT_EQ(all.occupied[1].precision, 4.0 / 5);
  EXPECT_EQ(all.occupied[1].recall, 5.0 / 5);  // the fifth is diagonal to the shifted cell
  EXPECT_DOUBLE_EQ(*all.occupied[1].f1, 8.0 / 9);
  EXPECT_EQ(all.occupied[2].precision, 4.0 / 5);  // the far one is three rows off
  EXPECT_EQ(all.confusion[2][1], 2);
  EXPECT_EQ(all.confusion[1][2], 2);
}

TEST(ScoreMap, DistancesByHand) {
  const StateMap truth = Drawn({"#...."});
  const StateMap estimate = Drawn({"#...#"});
  const CellScores all = ScoreMap(truth, estimate, std::nullopt).all;
  EXPECT_DOUBLE_EQ(*all.estimate_to_truth_m, 0.2);  // 0 and 0.4
  EXPECT_DOUBLE_EQ(*all.truth_to_estimate_m, 0.0);
  EXPECT_DOUBLE_EQ(*all.chamfer_m, 0.1);
  EXPECT_DOUBLE_EQ(*all.hausdorff95_m, 0.38);  // 95 % of the way from 0 to 0.4
}

TEST(ScoreMap, AWallThatCouldNotBeSeenCountsOnlyInTheAllScore) {
  const StateMap truth = Drawn({"#..??"});
  const StateMap estimate = Drawn({"#..?#"});
  const MapScore score = ScoreMap(truth, estimate, MaskDrawn({"###??"}));
  EXPECT_EQ(score.observable->occupied[1].precision, 1.0);
  EXPECT_EQ(score.all.occupied[1].precision, 0.5);
  EXPECT_EQ(score.observable->chamfer_m, 0.0);
  EXPECT_GT(*score.all.chamfer_m, 0.0);
}

// A truth cell at the rim of what was observable may be matched by an estimated cell beyond it.
TEST(ScoreMap, MatchesReachAcrossTheObservableRim) {
  const StateMap truth = Drawn({"..#?"});
  const StateMap estimate = Drawn({"..?#"});
  const MapScore score = ScoreMap(truth, estimate, MaskDrawn({"###."}));
  EXPECT_EQ(score.observable->occupied[1].recall, 1.0);
  EXPECT_FALSE(score.observable->occupied[1].precision);  // no estimated wall to judge
}

TEST(ScoreMap, CoverageIsTheKnownShareOfObservableCells) {
  const StateMap truth = Drawn({"#...???"});
  const StateMap estimate = Drawn({"#.??..?"});
  const MapScore score = ScoreMap(truth, estimate, MaskDrawn({"####..."}));
  EXPECT_EQ(score.observable->coverage, 0.5);
  EXPECT_EQ(score.all.coverage, 0.5);
  EXPECT_EQ(score.observable->scored_cells, 4);
}

TEST(ScoreMap, CoverageAsksForObservableCellsWhateverTheirTruth) {
  const MapScore score = ScoreMap(Drawn({"#.??"}), Drawn({"#..?"}), MaskDrawn({"####"}));
  EXPECT_EQ(score.observable->coverage, 0.75);
  EXPECT_EQ(score.all.coverage, 1.0);
}

TEST(ScoreMap, MapsNeedNotShareARectangle) {
  const StateMap truth = Drawn({"###", "..."}, {0, 0});
  const StateMap estimate = Drawn({"????", "###?", "...?"}, {0, 0});
  const StateMap moved = Drawn({"?###", "?..."}, {-1, 0});
  for (const StateMap& map : {estimate, moved}) {
    const CellScores all = ScoreMap(truth, map, std::nullopt).all;
    EXPECT_EQ(all.occupied[0].f1, 1.0);
    EXPECT_EQ(all.free[0].f1, 1.0);
  }
}

TEST(ScoreMap, AnEmptyEstimateHasRecallZeroAndNoPrecision) {
  const StateMap truth = Drawn({"#.."});
  const CellScores all = ScoreMap(truth, Drawn({"???"}), std::nullopt).all;
  EXPECT_EQ(all.occupied[1].recall, 0.0);
  EXPECT_FALSE(all.occupied[1].precision);
  EXPECT_FALSE(all.occupied[1].f1);
  EXPECT_FALSE(all.chamfer_m || all.truth_to_estimate_m);
  EXPECT_EQ(all.coverage, 0.0);
}

// Cells of the finer lattice from (-3, -1) on: columns -3 and -2 and -1, 0 and 1 are one each.
TEST(Coarsened, OccupiedIfAnyIsElseFreeIfAnyIs) {
  StateMap fine = DrawnMap({"?.??#",    //
                            "??.?.",    //
                            "????."});  // y = -1, alone in its row of two
  fine.geometry.min_cell = {-3, -1};
  StateMap expected = DrawnMap({"?.#",  //
                                "??."},
                               0.1);
  expected.geometry.min_cell = {-2, -1};
  EXPECT_EQ(Coarsened(fine, 2, 0.1), expected);
  EXPECT_EQ(Coarsened(fine, 1, 0.05), fine);
}

}  // namespace
}  // namespace depthgrid
