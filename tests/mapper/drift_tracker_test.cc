#include "mapper/fuse/drift_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/rng.h"
#include "mapper/fuse/drift_evidence.h"

namespace depthgrid {
namespace {

const Eigen::Vector3d kMatchSigma(0.01, 0.01, 0.002);

Eigen::Matrix3d MatchInformation() {
  return kMatchSigma.cwiseProduct(kMatchSigma).cwiseInverse().asDiagonal();
}

TEST(DriftEvidence, WhiteInnovationsGiveThreeInTheMean) {
  RandomStream random(4, RandomStage::kTest);
  DriftEvidence evidence;
  double sum = 0.0;
  constexpr int kStart = 200;
  constexpr int kFrames = 20000;
  for (int i = 0; i < kStart + kFrames; ++i) {
    const Eigen::Vector3d unit(random.Normal(), random.Normal(), random.Normal());
    evidence.Add(kMatchSigma.cwiseProduct(unit), MatchInformation());
    if (i >= kStart) sum += evidence.Chi2();
  }
  // 20,000 / 59 independent values of variance 6: the mean is known to 0.13.
  EXPECT_NEAR(sum / kFrames, 3.0, 0.4);
}

TEST(DriftEvidence, GrowsWithTheSquareOfASteadyInnovation) {
  // Half a sigma forward: the weights of 30 frames' memory sum up to 30, so 1.967 * 30 / 4.
  DriftEvidence evidence;
  for (int i = 0; i < 1000; ++i) evidence.Add({0.005, 0.0, 0.0}, MatchInformation());
  EXPECT_NEAR(evidence.Chi2(), (2.0 - 1.0 / 30.0) * 30.0 * 0.25, 0.01);
  // What no match sees counts nothing.
  DriftEvidence blind;
  for (int i = 0; i < 1000; ++i) blind.Add({0.005, 0.0, 0.0}, Eigen::Matrix3d::Zero());
  EXPECT_EQ(blind.Chi2(), 0.0);
}

// Of a camera at the origin.
MatchResult NoisyMatch(RandomStream& random) {
  MatchResult match;
  match.found = true;
  match.information = MatchInformation();
  match.map_from_base = Pose2::FromVector(
      kMatchSigma.cwiseProduct(Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal())));
  return match;
}

// A centimetre forward and back again, from frame to frame.
double ToAndFroM(int frame) { return frame % 2 == 0 ? 0.0 : 0.01; }
Pose2 ToAndFro(int frame) { return {ToAndFroM(frame), 0.0, 0.0}; }

// The camera goes to and fro; SLAM creeps forward by `creep_m` a frame in addition. Mean error over
// the frames. `map_m`: how well the map that is matched against is known.
double ErrorAfterM(DriftTracker& tracker, Pose2& slam, int frames, double creep_m,
                   std::uint64_t seed, double map_m = 0.0) {
  RandomStream random(seed, RandomStage::kTest);
  double sum_m = 0.0;
  for (int i = 0; i < frames; ++i) {
    slam = slam * Pose2{creep_m, 0.0, 0.0};
    const Pose2 now = slam * ToAndFro(i);
    MatchResult match = NoisyMatch(random);
    match.map_from_base.x_m += ToAndFroM(i);
    const Prediction prediction = tracker.Predict(now);
    const FusedPose fused = tracker.Fuse(now, match);
    tracker.Commit(now, fused.map_from_base, fused.covariance, match);
    tracker.AddInnovation(fused.innovation,
                          WithAddedCovariance(InnovationWeight(prediction, match.information),
                                              Squared({map_m, map_m, map_m})));
    sum_m += std::hypot(fused.map_from_base.x_m - ToAndFroM(i), fused.map_from_base.y_m);
  }
  return sum_m / frames;
}

const MotionSpread kNearlyPerfect{.sigma = {1e-5, 1e-5, 2e-6}, .frames = 6.0};

TEST(DriftTracker, BelievesAPriorThatTheAdjustmentFoundPerfect) {
  DriftTracker free, bound;
  Pose2 slam;
  ErrorAfterM(free, slam, 30, 0.0, 1);
  ErrorAfterM(bound, slam, 30, 0.0, 1);
  const MotionNoise before = bound.noise();
  bound.BoundMotion(kNearlyPerfect);
  EXPECT_GT(before.walk.maxCoeff() + before.bias.maxCoeff(), 1e-4);
  EXPECT_LE(bound.noise().bias.x(), 2e-5);
  EXPECT_LT(bound.noise().walk.x(), 2.1e-5 * std::sqrt(6.0));
  // And what is learnt later is bounded too.
  ErrorAfterM(bound, slam, 100, 0.0, 2);
  EXPECT_LT(bound.noise().walk.x(), 2.1e-5 * std::sqrt(6.0));
}

// The standard deviation of a motion that nothing is known of, in frames that last so long.
double FirstSigmaM(double usual_step_s) {
  DriftTracker tracker;
  tracker.Commit({}, {}, Eigen::Matrix3d::Zero(), {});
  tracker.SetFrames(1, usual_step_s);
  return std::sqrt(tracker.Predict({0.1, 0.0, 0.0}).covariance(0, 0));
}

TEST(DriftTracker, InLongFramesAnUnknownSlamErrsMoreAsAWalkDoes) {
  const double at_30_hz = FirstSigmaM(1.0 / 30.0);
  EXPECT_GT(at_30_hz, 0.0);
  EXPECT_EQ(FirstSigmaM(0.0), at_30_hz);
  EXPECT_EQ(FirstSigmaM(1.0 / 60.0), at_30_hz);
  EXPECT_NEAR(FirstSigmaM(0.14) / at_30_hz, 2.0, 1e-9);
  EXPECT_EQ(FirstSigmaM(5.0), FirstSigmaM(60.0));
}

TEST(DriftTracker, BeginsWithWhatAnotherHasLearnt) {
  DriftTracker first, second;
  Pose2 slam;
  ErrorAfterM(first, slam, 60, 0.02, 1);
  second.BeginWith(first, {.sigma = {0.02, 0.02, 0.005}, .frames = 9.0});
  EXPECT_GE(second.noise().walk.x(), first.noise().walk.x());
  const MotionNoise& noise = second.noise();
  EXPECT_NEAR(std::hypot(noise.bias.x(), noise.walk.x() / 3.0), 0.02, 0.02);
  EXPECT_GE(std::hypot(noise.bias.x(), noise.walk.x() / 3.0), 0.02 - 1e-12);
}

// A spread of few stretches says nothing of an axis that they hardly saw.
TEST(MotionSpread, OfFewStretchesTellsOnlyWhatTheySaw) {
  MotionSpread spread{.sigma = {1e-4, 1e-4, 1e-4}, .frames = 9.0, .stretches = 7};
  spread.seen_sigma = {0.2, 0.001, 0.0001};
  MotionNoise noise;
  noise.walk.setConstant(0.003);
  Bound(spread, noise);
  EXPECT_EQ(noise.walk.x(), 0.003);
  EXPECT_NEAR(noise.walk.y(), 6e-4, 1e-12);  // twice sigma over three
  spread.stretches = 20;
  Bound(spread, noise);
  EXPECT_NEAR(noise.walk.x(), 6e-4, 1e-12);
}

// Where SLAM errs by more than was thought at first few stretches do not let the filter follow it.
TEST(DriftTracker, AnUnsureSpreadOfLargeErrorsKeepsMatchesBelieved) {
  DriftTracker tracker;
  Pose2 slam;
  tracker.BoundMotion({.sigma = {0.01, 1e-4, 1e-4}, .frames = 9.0, .stretches = 7});
  ErrorAfterM(tracker, slam, 100, 0.0, 3);
  EXPECT_GE(tracker.noise().walk.x(), 0.0015);
  EXPECT_LT(tracker.noise().walk.y(), 0.0007);
}

TEST(DriftTracker, TellsErrorsWithoutItsOwnCaution) {
  DriftTracker tracker;
  Pose2 slam;
  RandomStream random(9, RandomStage::kTest);
  for (int i = 0; i < 1000; ++i) {
    slam = slam * Pose2{0.02 * random.Normal(), 0.0, 0.0};  // SLAM walks, the camera stands
    const MatchResult match = NoisyMatch(random);
    const FusedPose fused = tracker.Fuse(slam, match);
    tracker.Commit(slam, fused.map_from_base, fused.covariance, match);
  }
  EXPECT_NEAR(tracker.step().walk.x(), 0.02, 0.002);
  EXPECT_NEAR(tracker.noise().walk.x(), 1.4 * tracker.step().walk.x(), 1e-12);
}

TEST(DriftTracker, TellsErrorsAsLearntBeforeTheFirstAdjustment) {
  DriftTracker tracker;
  Pose2 slam;
  ErrorAfterM(tracker, slam, 150, 0.0, 6);
  EXPECT_EQ(tracker.noise().walk.minCoeff(), 0.0015);  // believed no less
  EXPECT_LT(tracker.step().walk.maxCoeff(), 0.001);
}

// A wall ahead: nothing is seen to the side, however long.
TEST(DriftTracker, WhereNothingIsSeenSlamIsNotTakenForPerfect) {
  DriftTracker tracker;
  RandomStream random(5, RandomStage::kTest);
  for (int i = 0; i < 2000; ++i) {
    const Pose2 slam = ToAndFro(i);
    MatchResult match = NoisyMatch(random);
    match.map_from_base.x_m += ToAndFroM(i);
    match.map_from_base.y_m = 0.0;
    match.information(1, 1) = 0.0;
    const FusedPose fused = tracker.Fuse(slam, match);
    tracker.Commit(slam, fused.map_from_base, fused.covariance, match);
  }
  EXPECT_LT(tracker.noise().walk.x(), 0.0015);
  EXPECT_EQ(tracker.noise().walk.y(), 1.4 * 0.003);
  EXPECT_EQ(tracker.step().walk.y(), 0.003);
}

// SLAM, long known to be good, starts anew where it is predicted to be, known to a decimetre.
TEST(DriftTracker, RestartedWhereItIsPredictedToBeItKnowsNoMoreThanItIsTold) {
  DriftTracker tracker;
  Pose2 slam;
  ErrorAfterM(tracker, slam, 500, 0.0, 7);
  const Eigen::Matrix3d told = Squared(Eigen::Vector3d(0.1, 0.1, 0.05));
  const Prediction before = tracker.Predict(slam);
  ASSERT_LT(before.covariance(0, 0), 1e-4);
  tracker.Restart(slam, before.map_from_base, told);
  EXPECT_EQ(tracker.Predict(slam).map_from_base, before.map_from_base);
  EXPECT_GE(tracker.Predict(slam).covariance(0, 0), 0.01);
  EXPECT_TRUE(tracker.step().new_bias);
  // A match 8 cm away is believed.
  RandomStream random(8, RandomStage::kTest);
  MatchResult match = NoisyMatch(random);
  match.map_from_base.x_m = before.map_from_base.x_m + 0.08;
  EXPECT_NEAR(tracker.Fuse(slam, match).map_from_base.x_m, match.map_from_base.x_m, 0.001);
}

TEST(DriftTracker, InnovationsThatAllPointOneWayLiftTheBound) {
  DriftTracker tracker;
  Pose2 slam;
  ErrorAfterM(tracker, slam, 100, 0.0, 1);
  tracker.BoundMotion(kNearlyPerfect);
  ErrorAfterM(tracker, slam, 200, 0.0, 2);
  EXPECT_LE(tracker.noise().bias.x(), 2e-5);
  // SLAM begins to drift by 3 mm a frame. Until that is certain the estimate drifts along.
  ErrorAfterM(tracker, slam, 100, 0.003, 3);
  EXPECT_GT(tracker.noise().walk.x() + tracker.noise().bias.x(), 1e-3);
  EXPECT_LT(ErrorAfterM(tracker, slam, 100, 0.003, 4), 0.02);
}

// Come back to an old part of the map the camera finds it off by what both wandered on the way.
TEST(DriftTracker, InnovationsThatTheMapExplainsLiftNoBound) {
  for (const double map_m : {0.0, 0.3}) {
    DriftTracker tracker;
    Pose2 slam;
    ErrorAfterM(tracker, slam, 100, 0.0, 1);
    tracker.BoundMotion(kNearlyPerfect);
    ErrorAfterM(tracker, slam, 200, 0.0, 2);
    slam = slam * Pose2{0.3, 0.0, 0.0};
    ErrorAfterM(tracker, slam, 100, 0.0, 3, map_m);
    EXPECT_EQ(tracker.noise().walk.x() > 1e-3, map_m == 0.0) << map_m;
  }
}

TEST(DriftTracker, BelievesAPriorThatDriftedOnlyAfterTheNextAdjustment) {
  DriftTracker tracker;
  Pose2 slam;
  ErrorAfterM(tracker, slam, 100, 0.0, 1);
  tracker.BoundMotion(kNearlyPerfect);
  ErrorAfterM(tracker, slam, 200, 0.003, 2);  // lifts the bound
  // However long matches agree with SLAM.
  for (int i = 0; i < 1000; ++i) {
    const Pose2 now = slam * ToAndFro(i);
    MatchResult match;
    match.found = true;
    match.information = MatchInformation();
    match.map_from_base = tracker.Predict(now).map_from_base;
    const FusedPose fused = tracker.Fuse(now, match);
    tracker.Commit(now, fused.map_from_base, fused.covariance, match);
  }
  EXPECT_GE(tracker.noise().walk.minCoeff(), 0.0015);
  EXPECT_GE(tracker.step().walk.minCoeff(), 0.0015);  // nor are errors told for smaller
  tracker.BoundMotion(kNearlyPerfect);
  EXPECT_LT(tracker.noise().walk.maxCoeff(), 1e-4);
}

TEST(DriftTracker, BelievesThePriorNoMoreThanAnAdjustmentDoes) {
  DriftTracker tracker;
  Pose2 slam;
  // SLAM drifts, but the matches are made against a map that drifts along: they agree with it.
  for (int i = 0; i < 1500; ++i) {
    if (i == 900) {
      // That is not believed at first.
      EXPECT_GT(tracker.noise().walk.minCoeff(), 0.001);
    }
    slam = slam * Pose2{0.001, 0.0, 0.0};
    MatchResult match;
    match.found = true;
    match.information = MatchInformation();
    match.map_from_base = slam;
    const FusedPose fused = tracker.Fuse(slam, match);
    tracker.Commit(slam, fused.map_from_base, fused.covariance, match);
  }
  EXPECT_LT(tracker.noise().walk.norm() + tracker.noise().bias.norm(), 1e-5);
  // The adjustment saw it.
  tracker.BoundMotion({{0.001, 0.0005, 0.00025}, 7.0});
  const MotionNoise& noise = tracker.noise();
  EXPECT_NEAR(std::hypot(noise.bias.x(), noise.walk.x() / std::sqrt(7.0)), 0.001, 1e-6);
  EXPECT_NEAR(noise.bias.y(), 0.0005, 1e-6);
  EXPECT_NEAR(noise.bias.z(), 0.00025, 1e-6);
  EXPECT_GT(noise.bias_kept.minCoeff(), 0.9);
}

}  // namespace
}  // namespace depthgrid
