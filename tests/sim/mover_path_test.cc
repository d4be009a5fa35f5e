#include "sim/scene/mover_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depthgrid {
namespace {

constexpr double kWalkS = 2.4 / 1.2 * 1.01;  // straight, with the margin of a camera path's timing
constexpr double kHalfTurnS = 180.0 / 120.0;

MoverOptions Straight() {
  MoverOptions options;
  options.waypoints = {{{1.0, 2.0}}, {{3.4, 2.0}}};
  return options;
}

Pose2 At(const MoverOptions& options, double time_s) {
  const auto pose = MoverPath(options).At(time_s, {});
  EXPECT_TRUE(pose.has_value()) << time_s << " s";
  return pose.value_or(Pose2{-1, -1, -1});
}

void ExpectAt(const MoverOptions& options, double time_s, const Pose2& expected) {
  const Pose2 pose = At(options, time_s);
  EXPECT_NEAR(pose.x_m, expected.x_m, 1e-6) << time_s << " s";
  EXPECT_NEAR(pose.y_m, expected.y_m, 1e-6) << time_s << " s";
  EXPECT_NEAR(std::abs(WrapAngle(pose.yaw_rad - expected.yaw_rad)), 0.0, 1e-6) << time_s << " s";
}

TEST(MoverPath, WalksOnceAndStands) {
  MoverOptions options = Straight();
  options.from_s = 5.0;
  ExpectAt(options, 0.0, {1.0, 2.0, 0.0});
  ExpectAt(options, 5.0, {1.0, 2.0, 0.0});
  ExpectAt(options, 5.0 + 0.25 * kWalkS, {1.6, 2.0, 0.0});
  ExpectAt(options, 5.0 + kWalkS, {3.4, 2.0, 0.0});
  ExpectAt(options, 1000.0, {3.4, 2.0, 0.0});
  EXPECT_NEAR(MoverPath(options).RoundS(), kWalkS, 1e-6);
}

TEST(MoverPath, IsThereOnlyWhileItWalks) {
  MoverOptions options = Straight();
  options.from_s = 5.0;
  options.stays = false;
  const MoverPath path(options);
  EXPECT_FALSE(path.At(4.999, {}).has_value());
  EXPECT_TRUE(path.At(5.0, {}).has_value());
  EXPECT_TRUE(path.At(5.0 + kWalkS - 1e-3, {}).has_value());
  EXPECT_FALSE(path.At(5.0 + kWalkS + 1e-3, {}).has_value());
}

TEST(MoverPath, TurnsAtBothEnds) {
  MoverOptions options = Straight();
  options.there_and_back = true;
  const double half_s = kWalkS + kHalfTurnS;
  EXPECT_NEAR(MoverPath(options).RoundS(), 2.0 * half_s, 1e-6);
  for (const double round_s : {0.0, 2.0 * half_s, 20.0 * half_s}) {
    ExpectAt(options, round_s + 0.5 * kWalkS, {2.2, 2.0, 0.0});
    const Pose2 turning = At(options, round_s + kWalkS + 0.5 * kHalfTurnS);
    EXPECT_NEAR(turning.x_m, 3.4, 1e-6);
    EXPECT_NEAR(std::abs(turning.yaw_rad), 0.5 * kPi, 1e-6);
    ExpectAt(options, round_s + half_s + 0.25 * kWalkS, {2.8, 2.0, kPi});
  }
  options.laps = 1.0;
  ExpectAt(options, 2.0 * half_s + 50.0, {1.0, 2.0, 0.0});
  options.laps = 0.5;
  ExpectAt(options, 50.0, {3.4, 2.0, kPi});
}

TEST(MoverPath, WaitsWhereItIsTold) {
  MoverOptions options = Straight();
  options.waypoints.push_back({{3.4, 4.4}});
  options.waypoints[1].wait_s = 4.0;
  // It turns at the end of the wait, by a right angle.
  constexpr double kTurnS = 90.0 / 120.0;
  ExpectAt(options, kWalkS + 4.0 - kTurnS, {3.4, 2.0, 0.0});
  ExpectAt(options, kWalkS + 4.0 - 0.5 * kTurnS, {3.4, 2.0, 0.25 * kPi});
  ExpectAt(options, kWalkS + 4.0 + 0.5 * kWalkS, {3.4, 3.2, 0.5 * kPi});
  EXPECT_NEAR(MoverPath(options).RoundS(), 2.0 * kWalkS + 4.0, 1e-6);
  // Round a triangle it stops at its first waypoint as well.
  options.closed = true;
  const double round_s = MoverPath(options).RoundS();
  ExpectAt(options, round_s, {1.0, 2.0, 0.0});
  ExpectAt(options, 3.0 * round_s + 0.5 * kWalkS, {2.2, 2.0, 0.0});
}

TEST(MoverPath, GoesRoundSmoothlyFacingWhereItGoes) {
  MoverOptions options;
  options.closed = true;
  options.waypoints = {{{0, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}}};
  const MoverPath path(options);
  constexpr double kStepS = 1e-3;
  int steps = 0;
  for (double time_s = kStepS; time_s < 2.5 * path.RoundS(); time_s += kStepS) {
    const Pose2 before = *path.At(time_s - kStepS, {});
    const Pose2 pose = *path.At(time_s, {});
    const Eigen::Vector2d way = pose.translation() - before.translation();
    ASSERT_LT(way.norm(), options.speed_mps * kStepS * 1.001) << time_s;
    ASSERT_GT(way.norm(), 0.2 * options.speed_mps * kStepS) << time_s;
    ASSERT_LT(std::abs(WrapAngle(std::atan2(way.y(), way.x()) - pose.yaw_rad)), 0.01) << time_s;
    ++steps;
  }
  EXPECT_GT(steps, 10'000);
  ExpectAt(options, 0.0, At(options, path.RoundS()));
}

TEST(MoverPath, KeepsAheadOfTheCamera) {
  MoverOptions options;
  options.ahead_m = 1.5;
  options.from_s = 2.0;
  const MoverPath path(options);
  EXPECT_FALSE(path.At(1.9, {}).has_value());
  const Pose2 pose = *path.At(2.0, {1.0, 2.0, 0.5 * kPi});
  EXPECT_NEAR(pose.x_m, 1.0, 1e-12);
  EXPECT_NEAR(pose.y_m, 3.5, 1e-12);
  EXPECT_NEAR(pose.yaw_rad, 0.5 * kPi, 1e-12);
}

}  // namespace
}  // namespace depthgrid
