// Planar poses drawn at random, and compared.
#pragma once

#include <gtest/gtest.h>

#include "mapper/core/pose2.h"
#include "mapper/core/rng.h"

namespace depthgrid {

inline Pose2 RandomPose(RandomStream& random) {
  return {random.Uniform(-5, 5), random.Uniform(-5, 5), random.Uniform(-kPi, kPi)};
}

inline void ExpectNear(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x_m, b.x_m, tolerance);
  EXPECT_NEAR(a.y_m, b.y_m, tolerance);
  EXPECT_NEAR(WrapAngle(a.yaw_rad - b.yaw_rad), 0.0, tolerance);
}

}  // namespace depthgrid
