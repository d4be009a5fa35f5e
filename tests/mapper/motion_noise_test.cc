#include "mapper/fuse/motion_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

TEST(MotionNoiseLearner, TellsJitterWalkAndBiasApart) {
  RandomStream random(13, RandomStage::kTest);
  const double kept = std::exp(-1.0 / 40.0);
  MotionNoiseLearner learner;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  double jitter_before = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double jitter = 0.003 * random.Normal();
    bias.x() = kept * bias.x() + std::sqrt(1.0 - kept * kept) * 0.001 * random.Normal();
    const Eigen::Vector3d error(bias.x(), 0.002 * random.Normal(), jitter - jitter_before);
    learner.Add(error, Eigen::Vector3d::Constant(1e-6));
    jitter_before = jitter;
  }
  const MotionNoise noise = learner.Fit();
  EXPECT_NEAR(noise.bias[0], 0.001, 3e-4);
  EXPECT_NEAR(noise.walk[1], 0.002, 3e-4);
  EXPECT_NEAR(noise.jitter[2], 0.003, 3e-4);
  EXPECT_LT(noise.walk[2], 3e-4);
  EXPECT_LT(noise.jitter[1], 5e-4);
}

// What a match does not see it takes from SLAM, so there it shows less of SLAM's jitter than it
// has, and claims to err by far more.
TEST(MotionNoiseLearner, BelievesGoodMatchesAboutJitter) {
  RandomStream random(14, RandomStage::kTest);
  MotionNoiseLearner learner;
  double before = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const bool sees = i / 50 % 2 == 0;
    const double match_sigma = sees ? 0.0002 : 0.01;
    const double jitter = 0.001 * random.Normal();
    const double off = sees ? jitter + match_sigma * random.Normal() : 0.1 * jitter;
    learner.Add(Eigen::Vector3d::Constant(off - before), Eigen::Vector3d::Constant(match_sigma));
    before = off;
  }
  EXPECT_NEAR(learner.Fit().jitter[0], 0.001, 1.5e-4);
}

TEST(MotionNoiseLearner, TakesTheNoiseOfMatchesForNoJitter) {
  RandomStream random(15, RandomStage::kTest);
  MotionNoiseLearner learner;
  double before = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double off = 0.002 * random.Normal();
    learner.Add(Eigen::Vector3d::Constant(off - before), Eigen::Vector3d::Constant(0.002));
    before = off;
  }
  EXPECT_LT(learner.Fit().jitter[0], 5e-4);
}

TEST(MotionNoise, IsBoundBySpread) {
  const MotionSpread spread{{0.001, 0.001, 0.001}, 4.0};
  MotionNoise noise;
  noise.walk = {0.0, 0.0012, 0.1};
  noise.bias = {0.0, 0.0001, 0.1};
  noise.bias_kept.setConstant(0.5);
  Bound(spread, noise);
  // Called perfect: all of it bias, which lasts as long as any before one is learnt.
  EXPECT_EQ(noise.bias[0], 0.001);
  EXPECT_EQ(noise.walk[0], 0.0);
  EXPECT_EQ(noise.bias_kept[0], MotionNoise().bias_kept[0]);
  // Called too good: over four frames the walk makes 0.6 of it.
  EXPECT_NEAR(noise.bias[1], 0.0008, 1e-12);
  EXPECT_EQ(noise.bias_kept[1], 0.5);
  // Called too bad.
  EXPECT_EQ(noise.bias[2], 0.002);
  EXPECT_EQ(noise.walk[2], 0.004);
}

}  // namespace
}  // namespace depthgrid
