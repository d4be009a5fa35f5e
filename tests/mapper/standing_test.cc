#include "mapper/core/standing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/rng.h"
#include "mapper/fuse/drift_tracker.h"
#include "mapper/surfel/frame_smoother.h"

namespace depthgrid {
namespace {

// The frames of so many that stand, given SLAM's motion to each and where it is matched.
template <typename Motion>
int StandingOf(int frames, const Motion& motion, double seen_step_m = 0.0) {
  Standing standing;
  int count = 0;
  for (int i = 0; i < frames; ++i) {
    const Pose2 step = motion(i);
    count += standing.After(step) ? 1 : 0;
    standing.Add(step, Pose2{i * seen_step_m, 0.0, 0.0});
  }
  return count;
}

TEST(Standing, StandsFromTheStartAndAgainAThirdOfASecondAfterAMotion) {
  EXPECT_EQ(StandingOf(50, [](int) { return Pose2{}; }), 50);
  EXPECT_EQ(StandingOf(50, [](int i) { return Pose2{i == 20 ? 0.05 : 0.0, 0.0, 0.0}; }), 40);
  EXPECT_EQ(StandingOf(50, [](int i) { return Pose2{0.0, 0.0, i == 20 ? 0.01 : 0.0}; }), 40);
}

// 1 mm a frame is left after six frames; 0.1 mm now and then.
TEST(Standing, WhatCreepsMoves) {
  EXPECT_EQ(StandingOf(200, [](int) { return Pose2{0.001, 0.0, 0.0}; }), 5);
  const int creeping = StandingOf(2000, [](int) { return Pose2{1e-4, 0.0, 0.0}; });
  EXPECT_GT(creeping, 1000);
  EXPECT_LT(creeping, 1900);
}

TEST(Standing, LastDigitsThatJitterStandAndJitterOfCentimetresMoves) {
  RandomStream random(1, RandomStage::kTest);
  for (const double jitter_m : {1e-4, 0.01}) {
    Pose2 before;
    const auto motion = [&](int) {
      const Pose2 pose{jitter_m * random.Normal(), jitter_m * random.Normal(),
                       jitter_m * random.Normal()};
      const Pose2 step = Between(before, pose);
      before = pose;
      return step;
    };
    EXPECT_EQ(StandingOf(500, motion) > 400, jitter_m < 0.001) << jitter_m;
  }
}

// A log without odometry.
TEST(Standing, WhatIsSeenToMoveMoves) {
  EXPECT_LT(StandingOf(
                200, [](int) { return Pose2{}; }, 0.02),
            10);
}

// People who walk away draw single matches along; who is carried is seen elsewhere all the time.
TEST(Standing, WhatIsBrieflySeenElsewhereStandsIfSlamMovedBefore) {
  const auto moving_after = [](bool moved, int frames_elsewhere) {
    Standing standing;
    standing.Add({moved ? 1.0 : 0.0, 0.0, 0.0}, Pose2{});
    for (int i = 0; i < 20; ++i) standing.Add({}, Pose2{});
    for (int i = 0; i < frames_elsewhere; ++i) standing.Add({}, Pose2{0.1, 0.0, 0.0});
    standing.Add({}, Pose2{});
    return !standing.After({});
  };
  EXPECT_FALSE(moving_after(true, 4));
  EXPECT_TRUE(moving_after(true, 5));
  EXPECT_TRUE(moving_after(false, 1));
}

MatchResult MatchAt(const Pose2& pose) {
  MatchResult match;
  match.found = true;
  match.map_from_base = pose;
  match.information = Eigen::Vector3d(1e4, 1e4, 1e6).asDiagonal();
  return match;
}

struct Stood {
  DriftTracker tracker;
  Pose2 slam;
  RandomStream random{3, RandomStage::kTest};

  // The camera at this pose; its error.
  double Add(const Pose2& truth) {
    const MatchResult match = MatchAt(
        truth * Pose2{0.01 * random.Normal(), 0.01 * random.Normal(), 0.001 * random.Normal()});
    const FusedPose fused = tracker.Fuse(slam, match);
    tracker.Commit(slam, fused.map_from_base, fused.covariance, match);
    return (fused.map_from_base.translation() - truth.translation()).norm();
  }
};

TEST(DriftTracker, StandingTeachesNothingOfMotions) {
  Stood run;
  for (int i = 0; i < 3000; ++i) run.Add({});
  // What stands is believed to.
  EXPECT_LT(run.tracker.Predict(run.slam).covariance(0, 0), 1e-6);
  // It drives off, and SLAM says 10 % too much.
  double most_m = 0.0;
  for (int i = 1; i <= 100; ++i) {
    run.slam = run.slam * Pose2{0.055, 0.0, 0.0};
    most_m = std::max(most_m, run.Add({0.05 * i, 0.0, 0.0}));
  }
  EXPECT_LT(most_m, 0.05);  // it followed SLAM to 0.47 m
}

TEST(DriftTracker, WhatWasLearntOutlastsAStand) {
  Stood run;
  const auto drive = [&](int from) {
    for (int i = from + 1; i <= from + 500; ++i) {
      run.slam = run.slam * Pose2{0.055, 0.0, 0.0};
      run.Add({0.05 * i, 0.0, 0.0});
    }
  };
  drive(0);
  const MotionNoise before = run.tracker.noise();
  for (int i = 0; i < 5000; ++i) run.Add({0.05 * 500, 0.0, 0.0});
  const MotionNoise& after = run.tracker.noise();
  EXPECT_GT(after.bias.x() + after.walk.x(), 0.7 * (before.bias.x() + before.walk.x()));
}

TEST(ErrorsOver, NoFrameIsNoError) {
  MotionNoise noise;
  noise.walk.setOnes();
  noise.bias.setOnes();
  const MotionErrors errors = ErrorsOver(0, noise);
  EXPECT_TRUE(errors.walk.isZero(0.0));
  EXPECT_TRUE(errors.bias_added.isZero(0.0));
  EXPECT_EQ(errors.bias_kept, Eigen::Vector3d::Ones());
  EXPECT_TRUE(errors.bias_renewed.isZero(0.0));
}

// SLAM, which walks by 1 cm a frame, stands for a while; matches are off by a centimetre.
TEST(Smoothed, WhereSlamStandsTheFramesStandToo) {
  RandomStream random(4, RandomStage::kTest);
  std::vector<SmootherFrame> run;
  for (int k = 0; k < 900; ++k) {
    const bool stands = k >= 300 && k < 600;
    SmootherFrame frame;
    frame.map_from_base = {0.05 * (std::min(k, 299) + std::max(k - 599, 0)), 0.0, 0.0};
    frame.match =
        MatchAt(frame.map_from_base * Pose2{0.01 * random.Normal(), 0.01 * random.Normal(), 0.0});
    frame.stands = stands;
    if (k > 0) frame.motion = Pose2{stands ? 0.0 : 0.05 + 0.01 * random.Normal(), 0.0, 0.0};
    run.push_back(frame);
  }
  MotionNoise noise = NoiseOf(run);
  EXPECT_NEAR(std::hypot(noise.walk.x(), noise.bias.x()), 0.01, 0.003);
  noise.jitter.setZero();
  const std::vector<Pose2> smoothed = Smoothed(run, noise, 0.3);
  for (std::size_t k = 300; k < 600; ++k) {
    EXPECT_NEAR(smoothed[k].x_m, run[k].map_from_base.x_m, 0.002);
    EXPECT_NEAR(smoothed[k].x_m, smoothed[300].x_m, 0.0005);
  }
}

}  // namespace
}  // namespace depthgrid
