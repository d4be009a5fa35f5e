#include "mapper/scan/stand_drift.h"

#include <gtest/gtest.h>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// Two windows in which the floor is seen to move by so much in each frame.
StandDrift After(double per_frame_m, double per_frame_deg) {
  StandDrift drift;
  for (int frame = 0; frame < 120; ++frame) {
    drift.Step(0.0);
    drift.Seen(per_frame_m, Eigen::Vector3d(RadFromDeg(per_frame_deg), 0.0, 0.0));
  }
  return drift;
}

void LookAway(StandDrift& drift, int frames) {
  for (int frame = 0; frame < frames; ++frame) drift.Step(0.0);
}

TEST(StandDrift, GoesOnAsItWasSeenTo) {
  StandDrift fast = After(0.005, 0.05), slow = After(0.0, 0.0);
  LookAway(fast, 60);
  LookAway(slow, 60);
  EXPECT_TRUE(fast.CanBe(0.3));
  EXPECT_TRUE(fast.CanTilt(RadFromDeg(3.0)));
  EXPECT_FALSE(fast.IsSlow());
  EXPECT_FALSE(slow.CanBe(0.1));
  EXPECT_FALSE(slow.CanTilt(RadFromDeg(3.0)));
  EXPECT_TRUE(slow.IsSlow());
  EXPECT_NEAR(fast.TiltIn(20.0), RadFromDeg(1.0), 1e-9);
}

// Errors of single frames that cancel each other are no drift.
TEST(StandDrift, NoiseIsNone) {
  StandDrift drift;
  for (int frame = 0; frame < 120; ++frame) {
    drift.Step(0.0);
    const double sign = frame % 2 == 0 ? 1.0 : -1.0;
    drift.Seen(0.01 * sign, Eigen::Vector3d(RadFromDeg(0.2) * sign, 0.0, 0.0));
  }
  LookAway(drift, 60);
  EXPECT_FALSE(drift.CanBe(0.1));
  EXPECT_TRUE(drift.IsSlow());
}

TEST(StandDrift, AJumpOfSlamIsBelieved) {
  StandDrift drift = After(0.0, 0.0);
  drift.Step(0.4);
  EXPECT_TRUE(drift.CanBe(0.4));
  EXPECT_FALSE(drift.CanBe(0.6));
  drift.Forget();
  EXPECT_TRUE(drift.CanBe(10.0));
  drift.Seen(0.0, Eigen::Vector3d::Zero());
  EXPECT_FALSE(drift.CanBe(0.1));
}

TEST(StandDrift, NothingIsKnownAtFirst) { EXPECT_FALSE(StandDrift().IsSlow()); }

}  // namespace
}  // namespace depthgrid
