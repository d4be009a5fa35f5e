#include "mapper/core/pose3.h"

#include <gtest/gtest.h>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

TEST(Rotation, ExpOfAQuarterTurnByHand) {
  const Eigen::Vector3d turned = ExpRotation({0, 0, kPi / 2}) * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((turned - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-15);
}

TEST(Rotation, LogUndoesExpInEveryRegime) {
  RandomStream random(11, RandomStage::kTest);
  int cases = 0;
  for (const double length : {0.0, 1e-13, 1e-8, 1e-4, 0.3, 3.1, kPi - 1e-9}) {
    for (int i = 0; i < 50; ++i, ++cases) {
      const Eigen::Vector3d axis =
          Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal()).normalized();
      const Eigen::Vector3d vector = length * axis;
      const Eigen::Quaterniond rotation = ExpRotation(vector);
      EXPECT_NEAR(rotation.norm(), 1.0, 1e-15);
      EXPECT_LE((LogRotation(rotation) - vector).norm(), 1e-15 + 1e-12 * length) << length;
      EXPECT_LE((LogRotation(Eigen::Quaterniond(-rotation.coeffs())) - vector).norm(),
                1e-15 + 1e-12 * length);
    }
  }
  EXPECT_EQ(cases, 350);
}

}  // namespace
}  // namespace depthgrid
