#include "mapper/fuse/fusion.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "mapper/core/rng.h"
#include "mapper/fuse/correction_filter.h"
#include "tests/mapper/poses.h"

namespace depthgrid {
namespace {

MatchResult MatchAt(const Pose2& pose, const Eigen::Matrix3d& information) {
  MatchResult match;
  match.found = true;
  match.map_from_base = pose;
  match.information = information;
  return match;
}

Eigen::Matrix3d RandomCovariance(RandomStream& random) {
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = random.Normal();
  return 0.01 * (root * root.transpose() + 0.1 * Eigen::Matrix3d::Identity());
}

TEST(Innovation, IsInBaseAxesAndWraps) {
  // Facing left along y: a step in y is forward, one in -x is left.
  const Eigen::Vector3d innovation = InnovationOf({1.0, 2.0, kPi / 2}, {0.9, 2.3, kPi / 2 + 0.1});
  EXPECT_NEAR(innovation.x(), 0.3, 1e-12);
  EXPECT_NEAR(innovation.y(), 0.1, 1e-12);
  EXPECT_NEAR(innovation.z(), 0.1, 1e-12);
  EXPECT_NEAR(InnovationOf({0, 0, 3.1}, {0, 0, -3.1}).z(), 2 * kPi - 6.2, 1e-12);
}

TEST(FuseWithGain, MovesEachAxisByItsShare) {
  const Prediction prediction{.map_from_base = {1.0, 2.0, kPi / 2}};
  const Pose2 matched{0.9, 2.3, kPi / 2 + 0.1};
  const FusedPose fused =
      FuseWithGain(prediction, MatchAt(matched, Eigen::Matrix3d::Identity()), {0.5, 0.0, 0.25});
  ExpectNear(fused.map_from_base, {1.0, 2.15, kPi / 2 + 0.025}, 1e-12);
}

TEST(FuseWithGain, ZeroAndOneAreExact) {
  RandomStream random(1, RandomStage::kTest);
  for (int i = 0; i < 100; ++i) {
    const Prediction prediction{.map_from_base = RandomPose(random)};
    const Pose2 matched = RandomPose(random);
    const MatchResult match = MatchAt(matched, Eigen::Matrix3d::Identity());
    EXPECT_EQ(FuseWithGain(prediction, match, {0, 0, 0}).map_from_base, prediction.map_from_base);
    EXPECT_EQ(FuseWithGain(prediction, match, {1, 1, 1}).map_from_base, matched);
  }
}

TEST(FuseWithGain, TheAngleTakesTheShortWay) {
  const Prediction prediction{.map_from_base = {0, 0, 3.1}};
  const MatchResult match = MatchAt({0, 0, -3.1}, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(FuseWithGain(prediction, match, {0, 0, 0.5}).map_from_base.yaw_rad, kPi, 1e-9);
}

TEST(FuseKalman, IsTheTextbookUpdate) {
  RandomStream random(2, RandomStage::kTest);
  for (int i = 0; i < 100; ++i) {
    const Prediction prediction{RandomPose(random), RandomCovariance(random)};
    const Eigen::Matrix3d noise = RandomCovariance(random);
    const Pose2 matched =
        prediction.map_from_base * Pose2{0.1 * random.Normal(), 0.1 * random.Normal(), 0.05};
    const FusedPose fused = FuseKalman(prediction, MatchAt(matched, noise.inverse()));
    const Eigen::Matrix3d gain = prediction.covariance * (prediction.covariance + noise).inverse();
    EXPECT_TRUE(fused.gain.isApprox(gain, 1e-9));
    const Eigen::Matrix3d posterior = (prediction.covariance.inverse() + noise.inverse()).inverse();
    EXPECT_TRUE(fused.covariance.isApprox(posterior, 1e-9));
    const Eigen::Vector3d innovation = InnovationOf(prediction.map_from_base, matched);
    EXPECT_NEAR(InnovationChi2(prediction, noise.inverse(), innovation),
                innovation.dot((prediction.covariance + noise).inverse() * innovation),
                1e-9 * innovation.squaredNorm() / 1e-3);
  }
}

TEST(FuseKalman, TakesUnseenDirectionsFromThePrediction) {
  Prediction prediction{.map_from_base = {1.0, 2.0, 0.5}};
  prediction.covariance = Eigen::Vector3d(1e-2, 1e-2, 1e-3).asDiagonal();
  const Eigen::Matrix3d corridor = Eigen::Vector3d(0.0, 1e6, 1e6).asDiagonal();
  const Pose2 matched = prediction.map_from_base * Pose2{0.3, 0.02, 0.01};
  const FusedPose fused = FuseKalman(prediction, MatchAt(matched, corridor));
  const Eigen::Vector3d step = InnovationOf(prediction.map_from_base, fused.map_from_base);
  EXPECT_NEAR(step.x(), 0.0, 1e-12);
  EXPECT_NEAR(step.y(), 0.02, 1e-5);
  EXPECT_NEAR(step.z(), 0.01, 1e-4);
  EXPECT_NEAR(fused.covariance(0, 0), 1e-2, 1e-12);
  EXPECT_LT(fused.covariance(1, 1), 1.1e-6);
  // Nothing seen at all, and nothing uncertain.
  EXPECT_EQ(FuseKalman(prediction, MatchAt(matched, Eigen::Matrix3d::Zero())).map_from_base,
            prediction.map_from_base);
  prediction.covariance.setZero();
  EXPECT_EQ(FuseKalman(prediction, MatchAt(matched, corridor)).map_from_base,
            prediction.map_from_base);
}

TEST(SeenSize, LeavesOutWhatTheMatchDoesNotSee) {
  RandomStream random(5, RandomStage::kTest);
  const Eigen::Matrix3d covariance = RandomCovariance(random);
  const Eigen::Vector3d innovation(0.02, -0.01, 0.005);
  const Eigen::Matrix3d all = Eigen::Vector3d(1e4, 2e4, 1e5).asDiagonal();
  EXPECT_EQ(SeenBasis(all).cols(), 3);
  EXPECT_NEAR(SeenSize(covariance, all, innovation).chi2,
              innovation.dot(covariance.inverse() * innovation), 1e-9);
  // A corridor at 30 degrees: its direction is neither counted nor known.
  const Eigen::Vector3d along(std::cos(kPi / 6), std::sin(kPi / 6), 0.0);
  const Eigen::Vector3d across(-along.y(), along.x(), 0.0);
  const Eigen::Matrix3d corridor = 1e6 * across * across.transpose() +
                                   Eigen::Matrix3d(Eigen::Vector3d(0.0, 0.0, 1e6).asDiagonal());
  EXPECT_EQ(SeenBasis(corridor).cols(), 2);
  const Eigen::Matrix3d known = 4e-4 * across * across.transpose() +
                                25.0 * along * along.transpose() +
                                Eigen::Matrix3d(Eigen::Vector3d(0.0, 0.0, 1e-4).asDiagonal());
  const Eigen::Vector3d off = 0.04 * across + 7.0 * along + Eigen::Vector3d(0.0, 0.0, 0.03);
  EXPECT_EQ(SeenSize(known, corridor, off).directions, 2);
  EXPECT_NEAR(SeenSize(known, corridor, off).chi2, 0.04 * 0.04 / 4e-4 + 0.03 * 0.03 / 1e-4, 1e-6);
  EXPECT_EQ(SeenSize(known, Eigen::Matrix3d::Zero(), off).chi2, 0.0);
}

// A wall along x, seen from anywhere: what tells of it is across it.
Eigen::Matrix3d InformationOfWall(double seen_yaw_rad) {
  const Eigen::Vector3d across(-std::sin(seen_yaw_rad), std::cos(seen_yaw_rad), 0.0);
  return 1e6 * across * across.transpose();
}

TEST(InformationIn, IsTheSameWallFromOtherAxes) {
  const MatchResult match = MatchAt({2.0, 1.0, 0.3}, InformationOfWall(-0.3));
  const Eigen::Matrix3d there = InformationIn({2.0, 1.0, 0.1}, match);
  EXPECT_NEAR((there - InformationOfWall(-0.1)).norm(), 0.0, 1e-4);
  EXPECT_NEAR((InformationIn(match.map_from_base, match) - match.information).norm(), 0.0, 1e-9);
}

// Turned and moved, a small motion's chi-square stays what it is.
TEST(InformationIn, KeepsWhatAMotionCosts) {
  RandomStream random(7, RandomStage::kTest);
  for (int i = 0; i < 20; ++i) {
    const Pose2 pose = RandomPose(random);
    const MatchResult match =
        MatchAt(pose * Pose2{0.02, -0.01, 0.03}, RandomCovariance(random).inverse());
    const Eigen::Vector3d small = 1e-6 * Eigen::Vector3d(random.Normal(), random.Normal(), 1.0);
    const Pose2 moved = pose * Pose2::FromVector(small) * Between(pose, match.map_from_base);
    const Eigen::Vector3d of_match = InnovationOf(match.map_from_base, moved);
    const double cost = of_match.dot(match.information * of_match);
    EXPECT_NEAR(small.dot(InformationIn(pose, match) * small), cost, 1e-3 * cost);
  }
}

TEST(InformationFor, AWallAlongTheWayTellsNothingOfTheWay) {
  Prediction prediction;
  prediction.covariance = Squared({0.3, 1e-3, 2e-4});
  const MatchResult tilted = MatchAt({}, InformationOfWall(5e-4));
  EXPECT_NEAR((InformationFor(prediction, tilted, 0.0) - tilted.information).norm(), 0.0, 1e-9);
  const Eigen::Matrix3d cleared = InformationFor(prediction, tilted, 1e-3);
  EXPECT_LT(cleared(0, 0), 1e-9);
  EXPECT_LT(std::abs(cleared(0, 1)), 1e-6);
  EXPECT_NEAR(cleared(1, 1), 1e6, 10.0);
}

TEST(InformationFor, WhatStandsAcrossTheWayIsKept) {
  Prediction prediction;
  prediction.covariance = Squared({0.3, 1e-3, 2e-4});
  const MatchResult oblique = MatchAt({}, InformationOfWall(0.2));
  EXPECT_NEAR((InformationFor(prediction, oblique, 1e-3) - oblique.information).norm(), 0.0, 100.0);
  const MatchResult corner =
      MatchAt({}, Eigen::Vector3d(1e4, 1e6, 1e5).asDiagonal().toDenseMatrix());
  const Eigen::Matrix3d kept = InformationFor(prediction, corner, 1e-3);
  EXPECT_NEAR(kept(0, 0), 1e4, 10.0);
  EXPECT_NEAR(kept(1, 1), 1e6, 1e-6);
}

TEST(Transported, IsTheCovarianceInTheNewAxes) {
  // Checked to first order: a pose error d before the motion is an error e after it.
  RandomStream random(3, RandomStage::kTest);
  int cases = 0;
  for (int i = 0; i < 50; ++i, ++cases) {
    const Pose2 motion = RandomPose(random);
    const double h = 1e-6;
    Eigen::Matrix3d jacobian;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d d = Eigen::Vector3d::Zero();
      d[axis] = h;
      jacobian.col(axis) = Between(motion, Pose2::FromVector(d) * motion).vector() / h;
    }
    const Eigen::Matrix3d covariance = RandomCovariance(random);
    const Eigen::Matrix3d expected = jacobian * covariance * jacobian.transpose();
    EXPECT_TRUE(Transported(covariance, motion).isApprox(expected, 1e-5));
  }
  EXPECT_EQ(cases, 50);
}

TEST(SlamStepCovariance, AddsJitterTimePathAndTurn) {
  SlamNoiseOptions noise{.jitter_m = 0.003,
                         .jitter_rad = 0.001,
                         .walk_m_per_sqrt_s = 0.02,
                         .walk_rad_per_sqrt_s = 0.01,
                         .path_share = 0.1,
                         .turn_share = 0.2};
  const Eigen::Matrix3d step = SlamStepCovariance(noise, {0.3, 0.4, -0.5}, 4.0);
  EXPECT_NEAR(step(0, 0), 9e-6 + 4 * 4e-4 + 0.0025, 1e-15);
  EXPECT_EQ(step(1, 1), step(0, 0));
  EXPECT_NEAR(step(2, 2), 1e-6 + 4 * 1e-4 + 0.01, 1e-15);
  EXPECT_EQ(step(0, 1), 0.0);
}

TEST(OracleGain, TakesWhatLeadsToTheTruth) {
  const Pose2 predicted{1.0, 1.0, 0.0};
  EXPECT_TRUE(OracleGain({1.05, 1.3, -0.1}, predicted, {1.1, 1.1, 0.1})
                  .isApprox(Eigen::Vector3d(0.5, 1.0, 0.0), 1e-12));
}

TEST(CorrectionFilter, RelativeCarriesTheCorrectionOnAndAbsoluteDoesNot) {
  for (const PriorMode prior : {PriorMode::kRelative, PriorMode::kAbsolute}) {
    FusionOptions options;
    options.prior = prior;
    CorrectionFilter filter(options);
    filter.Commit({1.0, 0.0, 0.0}, 0.0, {1.0, 0.1, 0.0}, Eigen::Matrix3d::Zero());
    const Pose2 expected =
        prior == PriorMode::kRelative ? Pose2{2.0, 0.1, 0.0} : Pose2{2.0, 0.0, 0.0};
    ExpectNear(filter.Predict({2.0, 0.0, 0.0}, 0.1).map_from_base, expected, 1e-12);
    filter.Commit({2.0, 0.0, 0.0}, 0.1, {2.0, 0.1, 0.0}, Eigen::Matrix3d::Zero());
    ExpectNear(filter.step().predicted, expected, 1e-12);
  }
}

// SLAM drifts 1 cm a frame. What is taken of a match is not in the next frame's prediction, which
// is known the worse the longer SLAM went: all is taken in the end.
TEST(CorrectionFilter, AnAbsolutePriorIsKnownWorseAndWorse) {
  for (const bool matched : {false, true}) {
    FusionOptions options;
    options.mode = FusionMode::kKalman;
    options.prior = PriorMode::kAbsolute;
    options.slam_noise.jitter_m = 0.01;
    CorrectionFilter filter(options);
    constexpr int kFrames = 400;
    for (int i = 0; i <= kFrames; ++i) {
      const Pose2 slam{0.01 * i, 0.0, 0.0};
      const Prediction prediction = filter.Predict(slam, 0.0);
      EXPECT_NEAR(prediction.covariance(0, 0), 1e-4 * i, 1e-9) << i;
      MatchResult match = MatchAt({}, 1e4 * Eigen::Matrix3d::Identity());
      match.found = matched;
      const FusedPose fused = filter.Fuse(slam, prediction, match, Eigen::Vector3d::Zero());
      filter.Commit(slam, 0.0, fused.map_from_base, fused.covariance);
      if (i == kFrames && matched) {
        EXPECT_GT(fused.gain(0, 0), 0.99);
      }
    }
  }
}

TEST(CorrectionFilter, StaysTheIdentityWhenNothingIsTaken) {
  FusionOptions options;
  options.mode = FusionMode::kFixed;
  CorrectionFilter filter(options);
  RandomStream random(4, RandomStage::kTest);
  for (int i = 0; i < 1000; ++i) {
    const Pose2 slam = RandomPose(random);
    const Prediction prediction = filter.Predict(slam, 0.1 * i);
    EXPECT_EQ(prediction.map_from_base, slam);
    const FusedPose fused = filter.Fuse(slam, prediction, MatchResult{}, Eigen::Vector3d::Zero());
    filter.Commit(slam, 0.1 * i, fused.map_from_base, fused.covariance);
    EXPECT_EQ(filter.map_from_slam(), Pose2{});
  }
}

TEST(CorrectionFilter, TheGateRefusesWildMatchesOnly) {
  FusionOptions options;
  options.gate_chi2 = 11.3;  // 1 % of 3 degrees of freedom
  options.mode = FusionMode::kKalman;
  const CorrectionFilter filter_of_options(options);
  CorrectionFilter filter = filter_of_options;
  Prediction prediction;
  prediction.covariance = 1e-4 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d information = 1e4 * Eigen::Matrix3d::Identity();
  // sigma of the innovation is 1.41 cm.
  const FusedPose taken =
      filter.Fuse({}, prediction, MatchAt({0.04, 0, 0}, information), Eigen::Vector3d::Zero());
  EXPECT_FALSE(taken.rejected);
  EXPECT_NEAR(taken.map_from_base.x_m, 0.02, 1e-12);
  const FusedPose refused =
      filter.Fuse({}, prediction, MatchAt({0.05, 0, 0}, information), Eigen::Vector3d::Zero());
  EXPECT_TRUE(refused.rejected);
  EXPECT_EQ(refused.map_from_base, Pose2{});
  EXPECT_NEAR(refused.innovation.x(), 0.05, 1e-12);
}

// A correction that walks at random, seen through white noise: there the best constant gain is
// known in closed form, K^2 = q (1 - K) with q the ratio of the two variances.
TEST(CorrectionFilter, AdaptiveFindsTheBestConstantGain) {
  for (const double q : {0.02, 0.2, 2.0}) {
    const double best = 0.5 * (-q + std::sqrt(q * q + 4.0 * q));
    FusionOptions options;
    options.mode = FusionMode::kAdaptive;
    options.adaptive_rate = 0.005;
    CorrectionFilter filter(options);
    RandomStream random(5, RandomStage::kTest);
    double true_x = 0.0;
    double gain_sum = 0.0;
    constexpr int kFrames = 8000;
    for (int i = 0; i < kFrames; ++i) {
      true_x += std::sqrt(q) * random.Normal();
      const Prediction prediction = filter.Predict({}, i);
      const FusedPose fused = filter.Fuse(
          {}, prediction, MatchAt({true_x + random.Normal(), 0, 0}, Eigen::Matrix3d::Identity()),
          Eigen::Vector3d::Zero());
      filter.Commit({}, i, fused.map_from_base, fused.covariance);
      if (i >= kFrames / 2) gain_sum += fused.gain(0, 0);
    }
    EXPECT_NEAR(gain_sum / (kFrames / 2), best, 0.06) << "q = " << q;
  }
}

}  // namespace
}  // namespace depthgrid
