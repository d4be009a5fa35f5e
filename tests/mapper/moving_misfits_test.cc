// Who walks is told from what stands piece by piece (docs/math.md, "What moves").
#include <gtest/gtest.h>

#include "mapper/fuse/correction_filter.h"
#include "mapper/fuse/drift_tracker.h"
#include "mapper/surfel/range_noise.h"
#include "mapper/surfel/scan_surfels.h"
#include "mapper/surfel/surfel_matcher.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

constexpr PairGates kGates{{0.05, 0.15, 0.7}, 2.5, 0.01, 0.3};

// A wall of surfels along x, a sigma of 1 cm: those from `young_from` on were drawn in frame 20.
SurfelStore WallMap(int young_from) {
  SurfelStore map;
  for (int i = 0; i < 40; ++i) {
    map.Add({{0.1 * i, 2.0}, {0.0, -1.0}, 1e4, 1e4}, i < young_from ? 0.0 : 20.0);
  }
  return map;
}

// The wall's surfels again, exact, and those at `off` 5 cm away from it: 5 / sqrt(2) sigmas.
std::vector<Surfel> WallPieces(const std::vector<std::size_t>& off) {
  std::vector<Surfel> pieces;
  for (int i = 0; i < 40; ++i) pieces.push_back({{0.1 * i, 2.0}, {0.0, -1.0}, 1e4, 1e4});
  for (const std::size_t i : off) pieces[i].point_m.y() += 0.05;
  return pieces;
}

SurfelPairs PairsOf(const std::vector<Surfel>& pieces, const SurfelStore& map) {
  SurfelPairs pairs;
  pairs.Assign(pieces);
  pairs.Associate(map, kGates, {});
  return pairs;
}

TEST(MovingMisfits, AreYoungAndFarOffAndNotAlone) {
  // 5 and 6 are old; 20 is alone; 30 and 31 are 10 cm, 36 and 39 30 cm apart.
  const std::vector<Surfel> pieces = WallPieces({5, 6, 20, 30, 31, 36, 39});
  SurfelPairs pairs = PairsOf(pieces, WallMap(10));
  EXPECT_EQ(pairs.MisfitsAt(10.0, {}), (std::vector<std::size_t>{30, 31}));
  // With all of them drawn long ago there are none; where all is off by as much, all are.
  EXPECT_TRUE(pairs.MisfitsAt(20.0, {}).empty());
  EXPECT_EQ(pairs.MisfitsAt(10.0, {0.0, -0.05, 0.0}).size(), 25U);
}

TEST(MovingMisfits, TakeAlongWhatIsNewAndNearThem) {
  const std::vector<Surfel> pieces = WallPieces({12, 13});
  SurfelPairs pairs = PairsOf(pieces, WallMap(10));
  ASSERT_EQ(pairs.MisfitsAt(10.0, {}), (std::vector<std::size_t>{12, 13}));
  // Within 40 cm of 12 or 13, without 8 and 9, which are old.
  EXPECT_EQ(pairs.YoungNear(10.0), (std::vector<std::size_t>{10, 11, 12, 13, 14, 15, 16}));
}

TEST(MovingMisfits, LeftOutOnceOrTwiceComeBack) {
  const std::vector<Surfel> pieces = WallPieces({12, 13});
  SurfelPairs pairs = PairsOf(pieces, WallMap(10));
  // Two of 12.5 each, all others 0.
  EXPECT_NEAR(pairs.Chi2At({}), 25.0, 1e-9);
  const PairEvaluation before = pairs.Evaluate(kGates, {});
  pairs.LeaveOut({12, 13});
  pairs.LeaveOut({11, 12, 13});
  EXPECT_EQ(pairs.Chi2At({}), 0.0);
  EXPECT_EQ(pairs.Evaluate(kGates, {}).used, before.used - 3);
  pairs.TakeInAll();
  EXPECT_EQ(pairs.Evaluate(kGates, {}).equations.h, before.equations.h);
}

// A tunnel whose walls tell nothing of the way along it, but for its end.
PlanarWorld TunnelWith(double person_x_m) {
  PlanarWorld walls = RectangleWorld(-2.0, -1.2, 5.0, 1.2);
  for (const Wall& side : RectangleWorld(person_x_m, -0.2, person_x_m + 0.4, 0.2)) {
    walls.push_back(side);
  }
  return walls;
}

// After four frames in which all is new somebody 1.5 m ahead steps away by `step_m`, and SLAM,
// which is good to `slam_sigma_m`, is off by `slam_m`.
MatchResult MatchBeforeAStep(double step_m, double slam_m, double slam_sigma_m, bool told = true) {
  const PlanarLaser laser{.sigma_of_range = 0.005};
  RangeNoise noise;
  ScanSurfelMaker maker({});
  SurfelStore map;
  for (int i = 0; i < 4; ++i) {
    const Scan scan = ScanOf(TunnelWith(1.5), {}, laser, 3, static_cast<std::uint32_t>(i));
    noise.Add(scan);
    for (const Surfel& piece : maker.Make(scan, noise)) map.Merge(piece, {0.05, 0.05, 0.7}, i);
  }
  const Scan scan = ScanOf(TunnelWith(1.5 + step_m), {}, laser, 3, 4);
  Prediction prediction{{slam_m, 0.0, 0.0}, Squared({0.02, 0.02, 0.01})};
  if (told) prediction.motion_covariance = Squared({slam_sigma_m, slam_sigma_m, 0.003});
  return SurfelMatcher({}).Match(maker.Make(scan, noise), map, prediction);
}

TEST(MovingMisfits, AreLeftOutFromTheFirstFrameOn) {
  const MatchResult match = MatchBeforeAStep(0.06, 0.0, 0.003);
  EXPECT_TRUE(match.left_out_misfits);
  EXPECT_LT(match.map_from_base.translation().norm(), 0.01);
  // Not where SLAM's newest motion is unknown.
  const MatchResult untold = MatchBeforeAStep(0.06, 0.0, 0.003, false);
  EXPECT_FALSE(untold.left_out_misfits);
  EXPECT_GT(untold.map_from_base.translation().norm(), 0.015);
}

TEST(MovingMisfits, AreNoneWhereNobodyMovesOrSlamErrsAlone) {
  EXPECT_FALSE(MatchBeforeAStep(0.0, 0.0, 0.003).left_out_misfits);
  // SLAM errs by ten of its sigmas: one motion of all explains that.
  const MatchResult match = MatchBeforeAStep(0.0, 0.03, 0.003);
  EXPECT_FALSE(match.left_out_misfits);
  EXPECT_LT(match.map_from_base.translation().norm(), 0.01);
}

// A match that claims 3 mm.
MatchResult MatchAt(double x_m, bool left_out) {
  MatchResult match;
  match.found = true;
  match.information = Squared({0.003, 0.003, 0.002}).inverse();
  match.map_from_base = {x_m, 0.0, 0.0};
  match.left_out_misfits = left_out;
  return match;
}

// SLAM is exact; half of the matches scatter by 1 cm and claim 3 mm. What is learnt of its jitter.
double JitterLearntM(bool left_out) {
  DriftTracker tracker;
  RandomStream random(9, RandomStage::kTest);
  for (int i = 0; i < 400; ++i) {
    const Pose2 slam{0.01 * i, 0.0, 0.0};
    const bool scatters = i % 50 >= 25;
    const double scatter_m = scatters ? 0.01 * random.Normal() : 0.0;
    const MatchResult match = MatchAt(slam.x_m + scatter_m, scatters && left_out);
    const FusedPose fused = tracker.Fuse(slam, match);
    tracker.Commit(slam, fused.map_from_base, fused.covariance, match);
  }
  return tracker.noise().jitter.x();
}

TEST(MovingMisfits, TeachNothingOfSlamsNoise) {
  EXPECT_GT(JitterLearntM(false), 0.003);
  EXPECT_LT(JitterLearntM(true), 1e-6);
}

TEST(MovingMisfits, AreJudgedByTheNewestMotionAlone) {
  FusionOptions options;
  options.mode = FusionMode::kLearned;
  CorrectionFilter filter(options);
  filter.Restart({}, 0.0, {}, Squared({0.5, 0.5, 0.5}));
  // Where the pose was placed anew no motion leads to it.
  EXPECT_FALSE(filter.Predict({}, 0.0).motion_covariance);
  const Pose2 slam{0.02, 0.0, 0.0};
  const Prediction next = filter.Predict(slam, 0.1);
  ASSERT_TRUE(next.motion_covariance);
  EXPECT_GT(next.covariance(0, 0), 0.25);
  EXPECT_NEAR((*next.motion_covariance)(0, 0), 0.003 * 0.003, 1e-12);
  filter.SetFrames(30, 0.0);  // after a pause
  EXPECT_FALSE(filter.Predict(slam, 1.0).motion_covariance);
}

}  // namespace
}  // namespace depthgrid
