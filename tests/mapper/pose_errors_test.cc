#include "mapper/fuse/pose_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "mapper/core/rng.h"
#include "mapper/fuse/fusion.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

const Eigen::Vector3d kWalk(0.004, 0.002, 0.003);
const Eigen::Vector3d kMatchSigma(0.006, 0.003, 0.002);

Eigen::Matrix3d MatchInformation() {
  return kMatchSigma.cwiseProduct(kMatchSigma).cwiseInverse().asDiagonal();
}

// Round a circle of 2 m.
Pose2 TruePose(int frame) {
  const double angle = 0.02 * frame;
  return {2.0 * std::sin(angle), 2.0 - 2.0 * std::cos(angle), angle};
}

FilterStep StepAt(int frame, const Eigen::Vector3d& gain) {
  FilterStep step;
  step.predicted = TruePose(frame);
  if (frame == 0) return step;
  step.walk = kWalk;
  step.gain = gain.asDiagonal();
  step.state_gain.topRows<3>() = step.gain;
  return step;
}

MapPart PartOf(double mapped) { return {mapped, MatchInformation(), 0.0}; }

TEST(PoseErrors, AgainstAnExactMapAreThoseOfTheFilter) {
  PoseErrors errors(1000);
  Prediction prediction;
  for (int i = 0; i < 100; ++i) {
    // Drawn before the first frame: a finished map.
    const MapPart part = PartOf(-5.0);
    MatchResult match;
    match.map_from_base = TruePose(i);
    match.information = MatchInformation();
    if (i > 0) {
      prediction.covariance =
          Transported(prediction.covariance, Between(TruePose(i - 1), TruePose(i)));
      prediction.covariance += kWalk.cwiseProduct(kWalk).asDiagonal();
    }
    prediction.map_from_base = TruePose(i);
    FilterStep step = StepAt(i, Eigen::Vector3d::Zero());
    if (i > 0) {
      const FusedPose fused = FuseKalman(prediction, match);
      step.gain = fused.gain;
      step.state_gain.topRows<3>() = fused.gain;
      prediction.covariance = fused.covariance;
    }
    errors.Add(step, i, i, MatchInformation(), {&part, 1});
  }
  EXPECT_EQ(errors.motion_from(), 0);
  EXPECT_TRUE(errors.MotionCovariance(TruePose(99)).isApprox(prediction.covariance, 1e-9));
}

TEST(PoseErrors, WithoutMatchesAreSlamsMotions) {
  PoseErrors errors(1000);
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  for (int i = 0; i <= 50; ++i) {
    errors.Add(StepAt(i, Eigen::Vector3d::Zero()), i, i, Eigen::Matrix3d::Zero(), {});
    if (i == 0) continue;
    expected = Transported(expected, Between(TruePose(i - 1), TruePose(i)));
    expected += kWalk.cwiseProduct(kWalk).asDiagonal();
  }
  EXPECT_TRUE(errors.MotionCovariance(TruePose(50)).isApprox(expected, 1e-9));
}

TEST(PoseErrors, WhatAFrameDrewTellsTheMotionFromIt) {
  // However badly frame 20 is known: a later match, taken as it is, against what it alone drew is
  // off by the match's noise.
  PoseErrors errors(20);
  for (int i = 0; i <= 30; ++i) {
    const MapPart part = PartOf(20.0);
    const bool matched = i > 20;
    errors.Add(StepAt(i, matched ? Eigen::Vector3d::Ones() : Eigen::Vector3d::Zero()), i, i,
               MatchInformation(), {&part, matched ? 1U : 0U});
  }
  EXPECT_EQ(errors.motion_from(), 20);
  const Eigen::Matrix3d noise = kMatchSigma.cwiseProduct(kMatchSigma).asDiagonal();
  EXPECT_TRUE(errors.MotionCovariance(TruePose(30)).isApprox(noise, 1e-6));
}

// Errors as they come about, on estimates that are off: frames match what those 3 to 12 frames
// before drew.
TEST(PoseErrors, AgreeWithManySimulatedRuns) {
  constexpr int kRuns = 400;
  constexpr int kFrames = 80;
  const Eigen::Vector3d gain(0.5, 0.7, 0.3);
  RandomStream random(7, RandomStage::kTest);
  const auto normal = [&](const Eigen::Vector3d& sigma) -> Eigen::Vector3d {
    return sigma.cwiseProduct(Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal()));
  };
  PoseErrors errors(1000);
  for (int i = 0; i <= kFrames; ++i) {
    std::vector<MapPart> parts;
    for (int k = 3; k <= 12 && i - k >= 0; ++k) parts.push_back(PartOf(i - k));
    errors.Add(StepAt(i, parts.empty() ? Eigen::Vector3d::Zero() : gain), i, i, MatchInformation(),
               parts);
    if (i == kFrames / 2) errors.Break();  // motions are told from the frame after
  }
  constexpr int kFrom = kFrames / 2 + 1;
  ASSERT_EQ(errors.motion_from(), kFrom);
  const Eigen::LDLT<Eigen::Matrix3d> factor(errors.MotionCovariance(TruePose(kFrames)));
  ASSERT_TRUE(errors.innovation_covariance());
  double sum = 0.0;
  double innovations = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<Eigen::Vector3d> error = {Eigen::Vector3d::Zero()};  // in map axes
    for (int i = 1; i <= kFrames; ++i) {
      const Eigen::Matrix3d map_from_base = AdjointOf(TruePose(i));
      const Eigen::Matrix3d base_from_map = AdjointOf(Inverse(TruePose(i)));
      Eigen::Vector3d predicted = error.back() + map_from_base * normal(kWalk);
      Eigen::Vector3d map = Eigen::Vector3d::Zero();
      int parts = 0;
      for (int k = 3; k <= 12 && i - k >= 0; ++k, ++parts) {
        map += error[static_cast<std::size_t>(i - k)];
      }
      if (parts > 0) {
        const Eigen::Vector3d match = map / parts + map_from_base * normal(kMatchSigma);
        if (i == kFrames) {
          innovations += SeenSize(*errors.innovation_covariance(), MatchInformation(),
                                  base_from_map * (match - predicted))
                             .chi2;
        }
        predicted += map_from_base * gain.asDiagonal() * base_from_map * (match - predicted);
      }
      error.push_back(predicted);
    }
    const Eigen::Vector3d motion = AdjointOf(Inverse(TruePose(kFrames))) *
                                   (error.back() - error[static_cast<std::size_t>(kFrom)]);
    sum += motion.dot(factor.solve(motion));
  }
  // 1,200 degrees of freedom: the mean of one is known to 4 %; the parts are merged to remembered
  // frames where they are old.
  EXPECT_NEAR(sum / (3.0 * kRuns), 1.0, 0.12);
  EXPECT_NEAR(innovations / (3.0 * kRuns), 1.0, 0.12);
}

TEST(PoseErrors, OfACameraLastWhileTheViewDoes) {
  // At rest before an exact map, matched poses taken as they are.
  const LastingError lasting = LastingErrorOfCamera(3.0);
  PoseErrors errors(10);
  constexpr int kFirst = 10;
  constexpr int kLast = 19;
  double kept = 1.0;
  for (int i = 0; i <= kLast; ++i) {
    const MapPart part = PartOf(-5.0);
    FilterStep step = StepAt(0, Eigen::Vector3d::Zero());
    step.gain = Eigen::Matrix3d::Identity();
    step.state_gain.topRows<3>() = step.gain;
    errors.Add(step, i, i, MatchInformation(), {&part, 1}, lasting);
    if (i > kFirst) kept *= 1.0 - 1.0 / (1.0 + 0.4 * (i + 5));
  }
  ASSERT_EQ(errors.motion_from(), kFirst);
  const Eigen::Matrix3d noise = Squared(kMatchSigma);
  const Eigen::Matrix3d lasts = 3.0 * noise + Squared(lasting.least);
  EXPECT_TRUE(errors.MotionCovariance(TruePose(0))
                  .isApprox(2.0 * noise + 2.0 * (1.0 - kept) * lasts, 1e-9));
}

// The last motion's variance forward, in a round trip through a room.
double VarianceForward(const std::optional<CameraStand>& stand, double lasting_share) {
  const PlanarWorld room = RectangleWorld(0.0, 0.0, 6.0, 5.0);
  MapperOptions options;
  options.fusion.lasting_share = lasting_share;
  IncrementalMapper mapper(options, std::nullopt);
  FrameReport report;
  for (int i = 0; i < 60; ++i) {
    const Pose2 truth = {3.0 + 0.02 * i, 2.5, 0.05 * i};
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan = std::make_shared<Scan>(
        ScanOf(room, truth, {.beams = 160, .sigma_of_range = 0.01}, 5, static_cast<unsigned>(i)));
    frame.stand = stand;
    frame.slam_from_camera = CameraOf(truth, 0.5);
    report = mapper.AddFrame(frame);
  }
  return report.motion_covariance(0, 0);
}

TEST(PoseErrors, LastForCamerasOnly) {
  const CameraStand upright = StandOf(CameraOf(Pose2(), 0.5), 0.0);
  const double scanner = VarianceForward(std::nullopt, 1.0);
  EXPECT_EQ(VarianceForward(std::nullopt, 0.0), scanner);
  EXPECT_EQ(VarianceForward(upright, 0.0), scanner);
  EXPECT_GT(VarianceForward(upright, 1.0), 1.2 * scanner);
}

TEST(PoseErrors, TellInnovationsOnlyOfFramesThatMatched) {
  PoseErrors errors(1000);
  const MapPart part = PartOf(-1.0);
  errors.Add(StepAt(0, Eigen::Vector3d::Zero()), 0, 0, MatchInformation(), {&part, 1});
  EXPECT_FALSE(errors.innovation_covariance());  // the first pose is the origin
  errors.Add(StepAt(1, Eigen::Vector3d::Ones()), 1, 1, MatchInformation(), {&part, 1});
  ASSERT_TRUE(errors.innovation_covariance());
  // Against an exact map: SLAM's step and the match's noise.
  const Eigen::Matrix3d expected = Squared(kWalk) + Squared(kMatchSigma);
  EXPECT_TRUE(errors.innovation_covariance()->isApprox(expected, 1e-9));
  errors.Add(StepAt(2, Eigen::Vector3d::Zero()), 2, 2, Eigen::Matrix3d::Zero(), {});
  EXPECT_FALSE(errors.innovation_covariance());
}

TEST(PoseErrors, StretchesEndWhereTheNextBegins) {
  PoseErrors errors(10);
  std::vector<int> from;
  for (int i = 0; i < 40; ++i) {
    errors.Add(StepAt(i, Eigen::Vector3d::Zero()), 2 * i, i, Eigen::Matrix3d::Zero(), {});
    from.push_back(errors.motion_from());
    if (i == 15) {
      EXPECT_TRUE(errors.MotionCovariance(TruePose(i)).isZero(1e-15));
    }
    if (i == 14) errors.Break();
  }
  for (int i = 0; i < 40; ++i) {
    const int expected = i <= 10 ? 0 : i <= 14 ? 20 : i <= 25 ? 30 : i <= 35 ? 50 : 70;
    EXPECT_EQ(from[static_cast<std::size_t>(i)], expected) << i;
  }
}

// Frames 0 to 9 were adjusted together; the tenth is matched against what the fifth drew.
TEST(PoseErrors, GoOnFromWhatAnAdjustmentLeft) {
  PoseErrors errors(1000);
  for (int i = 0; i < 10; ++i) {
    errors.Add(StepAt(i, Eigen::Vector3d::Zero()), i, i, Eigen::Matrix3d::Zero(), {});
  }
  const std::vector<int> mapped = errors.Mapped();
  ASSERT_EQ(mapped.size(), 10U);
  EXPECT_EQ(mapped[5], 5);
  RandomStream random(11, RandomStage::kTest);
  Eigen::MatrixXd root(30, 30);
  for (Eigen::Index i = 0; i < root.size(); ++i) root(i) = 1e-3 * random.Normal();
  const Eigen::MatrixXd left = root * root.transpose();
  errors.Adjusted(left, {});

  const auto between = [&](int a, int b) -> Eigen::Matrix3d {
    const auto block = [&](int row, int column) -> Eigen::Matrix3d {
      return left.block<3, 3>(3 * row, 3 * column);
    };
    const Eigen::Matrix3d difference = block(a, a) + block(b, b) - block(a, b) - block(b, a);
    return difference;
  };
  const auto in_base = [](const Eigen::Matrix3d& covariance, int frame) -> Eigen::Matrix3d {
    const Eigen::Matrix3d base_from_map = AdjointOf(Inverse(TruePose(frame)));
    return base_from_map * covariance * base_from_map.transpose();
  };
  EXPECT_TRUE(errors.MotionCovariance(TruePose(9)).isApprox(in_base(between(9, 0), 9), 1e-9));

  const MapPart part = PartOf(5.0);
  errors.Add(StepAt(10, Eigen::Vector3d::Ones()), 10, 10, MatchInformation(), {&part, 1});
  const Eigen::Matrix3d expected = in_base(between(5, 0), 10) + Squared(kMatchSigma);
  EXPECT_TRUE(errors.MotionCovariance(TruePose(10)).isApprox(expected, 1e-9));
  const Eigen::Matrix3d innovation =
      in_base(between(9, 5), 10) + Squared(kWalk) + Squared(kMatchSigma);
  EXPECT_TRUE(errors.innovation_covariance()->isApprox(innovation, 1e-9));
}

TEST(PoseErrors, GoOnWithANewBiasAfterAnAdjustment) {
  const Eigen::Vector3d bias(0.002, 0.001, 0.003);
  PoseErrors errors(1000);
  for (int i = 0; i < 3; ++i) {
    errors.Add(StepAt(i, Eigen::Vector3d::Zero()), i, i, Eigen::Matrix3d::Zero(), {});
  }
  errors.Adjusted(Eigen::MatrixXd::Zero(9, 9), bias);
  EXPECT_TRUE(errors.MotionCovariance(TruePose(2)).isZero(1e-15));
  errors.Add(StepAt(3, Eigen::Vector3d::Zero()), 3, 3, Eigen::Matrix3d::Zero(), {});
  const Eigen::Matrix3d expected = Squared(kWalk) + Squared(bias);
  EXPECT_TRUE(errors.MotionCovariance(TruePose(3)).isApprox(expected, 1e-9));
}

// Poses in a country's coordinates.
TEST(PoseErrors, AreTheSameFarAway) {
  const Pose2 far{450000.0, 5400000.0, 0.0};
  PoseErrors errors(1000), far_errors(1000);
  for (int i = 0; i < 400; ++i) {
    const MapPart part = PartOf(std::max(i - 10, 0));
    FilterStep step = StepAt(i, {0.3, 0.3, 0.3});
    errors.Add(step, i, i, MatchInformation(), {&part, 1});
    step.predicted = far * step.predicted;
    far_errors.Add(step, i, i, MatchInformation(), {&part, 1});
  }
  const Eigen::Matrix3d expected = errors.MotionCovariance(TruePose(399));
  EXPECT_TRUE(far_errors.MotionCovariance(far * TruePose(399)).isApprox(expected, 1e-6));
}

// SLAM begins anew at the fourth frame, which is matched against what the first one drew.
TEST(PoseErrors, KnowHowUncertainlyAnEpochBegins) {
  const Eigen::Vector3d start(0.1, 0.05, 0.02), bias(0.002, 0.001, 0.003);
  PoseErrors errors(1000);
  for (int i = 0; i < 4; ++i) {
    errors.Add(StepAt(i, Eigen::Vector3d::Zero()), i, i, Eigen::Matrix3d::Zero(), {});
  }
  const Eigen::Matrix3d before = errors.MotionCovariance(TruePose(3));
  errors.BeginEpoch(TruePose(4), Squared(start), bias);
  const MapPart part = PartOf(0.0);
  FilterStep step = StepAt(4, Eigen::Vector3d::Zero());
  step.bias_kept.setOnes();
  errors.Add(step, 4, 4, MatchInformation(), {&part, 1});
  const Eigen::Matrix3d expected = Transported(before, Between(TruePose(3), TruePose(4))) +
                                   Squared(start) + Squared(bias) + Squared(kWalk) +
                                   Squared(kMatchSigma);
  EXPECT_TRUE(errors.innovation_covariance()->isApprox(expected, 1e-9));
  EXPECT_EQ(errors.motion_from(), 4);
}

TEST(PoseErrors, StayWhereAnAdjustmentDoesNotTellThem) {
  PoseErrors errors(1000);
  for (int i = 0; i < 5; ++i) {
    errors.Add(StepAt(i, Eigen::Vector3d::Zero()), i, i, Eigen::Matrix3d::Zero(), {});
  }
  const Eigen::Matrix3d before = errors.MotionCovariance(TruePose(4));
  errors.Adjusted({}, {});
  EXPECT_EQ(errors.MotionCovariance(TruePose(4)), before);
}

}  // namespace
}  // namespace depthgrid
