#include "mapper/fuse/match_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

const Eigen::Vector3d kSigma(0.01, 0.005, 0.002);

// Innovations of `variance` times what matches claim, told with the factor so far. Its mean over
// the later half.
double FactorFound(double variance, int wrong_one_in = 0) {
  constexpr int kInnovations = 4000;
  RandomStream random(3, RandomStage::kTest);
  MatchNoise noise;
  double sum = 0.0;
  for (int i = 0; i < kInnovations; ++i) {
    const Eigen::Vector3d unit(random.Normal(), random.Normal(), random.Normal());
    Eigen::Vector3d innovation = std::sqrt(variance) * kSigma.cwiseProduct(unit);
    if (wrong_one_in > 0 && i % wrong_one_in == 0) innovation *= 100.0;
    const Eigen::Matrix3d claimed = Squared(kSigma);
    noise.Add(SeenSize(noise.factor() * claimed, claimed.inverse(), innovation));
    if (i >= kInnovations / 2) sum += noise.factor();
  }
  return sum / (kInnovations / 2);
}

TEST(MatchNoise, IsThatOfTheInnovations) {
  // 2,000 innovations of 3 degrees of freedom: known to 2 %, and one that is large is cut.
  for (const double variance : {0.5, 1.0, 2.0}) {
    EXPECT_NEAR(FactorFound(variance) / variance, 1.0, 0.05) << variance;
  }
}

TEST(MatchNoise, HardlyKnowsOfSingleWrongMatches) { EXPECT_NEAR(FactorFound(1.0, 100), 1.0, 0.1); }

TEST(MatchNoise, StaysWithinItsLimits) {
  EXPECT_NEAR(FactorFound(1e-6), 0.2, 1e-9);
  EXPECT_NEAR(FactorFound(1e6), 5.0, 1e-9);
}

TEST(MatchNoise, LearnsNothingWhereNothingIsSeen) {
  MatchNoise noise;
  noise.Add(SeenSize(Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero(), {9.0, 9.0, 9.0}));
  EXPECT_EQ(noise.factor(), 1.0);
}

}  // namespace
}  // namespace depthgrid
