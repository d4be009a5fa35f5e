#include "mapper/io/laser_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/pose2.h"

namespace depthgrid {
namespace {

constexpr int kBeams = 360;
const Eigen::Vector3d kVelocity(0.8, 0.1, 1.2);

// The range to the walls of a square room of 8 m around the origin.
double RangeFrom(const Pose2& room_from_laser, double bearing_rad) {
  const double heading_rad = room_from_laser.yaw_rad + bearing_rad;
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  const double x_m = ((c > 0.0 ? 4.0 : -4.0) - room_from_laser.x_m) / c;
  const double y_m = ((s > 0.0 ? 4.0 : -4.0) - room_from_laser.y_m) / s;
  return std::min(x_m, y_m);
}

// A whole turn from a laser that moves, at the origin when stamped.
Scan Swept(const LaserSweep& sweep, SweepOrder order) {
  Scan scan;
  for (int i = 0; i < kBeams; ++i) {
    const double share = i / (kBeams - 1.0);
    const double passed = order == SweepOrder::kAsListed ? share : 1.0 - share;
    const Pose2 at = Pose2::FromVector((passed - sweep.stamp_share) * sweep.duration_s * kVelocity);
    Beam beam;
    beam.bearing_rad = static_cast<float>(kPi * (2.0 * share - 1.0));
    beam.range_m = static_cast<float>(RangeFrom(at, beam.bearing_rad));
    beam.clear_to_m = beam.range_m;
    beam.hit = true;
    scan.beams.push_back(beam);
  }
  return scan;
}

double FarthestOffWall(const Scan& scan) {
  double most_m = 0.0;
  for (const Beam& beam : scan.beams) {
    most_m = std::max(most_m, std::abs(beam.range_m - RangeFrom({}, beam.bearing_rad)));
  }
  return most_m;
}

TEST(LaserSweep, AScanIsAsSeenAtItsStamp) {
  for (const SweepOrder order : {SweepOrder::kAsListed, SweepOrder::kReversed}) {
    for (const double stamp_share : {0.0, 0.5, 1.0}) {
      SCOPED_TRACE(stamp_share);
      const LaserSweep sweep{0.1, stamp_share};
      const Scan swept = Swept(sweep, order);
      EXPECT_GT(FarthestOffWall(swept), 0.1);
      const Scan seen = AtStamp(swept, sweep, order, kVelocity);
      EXPECT_LT(FarthestOffWall(seen), 1e-4);
      for (const Beam& beam : seen.beams) EXPECT_EQ(beam.clear_to_m, beam.range_m);
    }
  }
}

TEST(LaserSweep, WhatClearsOnlyTurnsAlong) {
  const Scan scan{.beams = {{.bearing_rad = 0.0F}, {1.0F, 0.0F, 0.0F, 5.0F, false}}};
  const Scan seen = AtStamp(scan, {0.5, 0.0}, SweepOrder::kAsListed, kVelocity);
  EXPECT_EQ(seen.beams[0], scan.beams[0]);
  EXPECT_FLOAT_EQ(seen.beams[1].bearing_rad, 1.6F);
  EXPECT_EQ(seen.beams[1].clear_to_m, 5.0F);
}

TEST(LaserVelocity, IsOfTheMotionSinceThePoseBeforeInTheLasersAxes) {
  LaserVelocity velocity;
  const Eigen::Vector3d standing = Eigen::Vector3d::Zero();
  const Pose2 west{1.0, 2.0, kPi};
  EXPECT_EQ(velocity.To(5.0, west, 0), standing);
  const Eigen::Vector3d going(0.5, 0.0, 0.2);
  const Pose2 on = west * Pose2::FromVector(0.1 * going);
  EXPECT_LT((velocity.To(5.1, on, 0) - going).norm(), 0.01);
  EXPECT_LT(velocity.To(5.2, on, 0).norm(), 1e-9);
}

// A pause, a lost pose, a correction, a jump.
TEST(LaserVelocity, IsZeroWhereTheMotionSaysNothing) {
  const Eigen::Vector3d standing = Eigen::Vector3d::Zero();
  LaserVelocity velocity;
  velocity.To(0.0, {}, 0);
  EXPECT_EQ(velocity.To(1.1, {0.3, 0.0, 0.0}, 0), standing);
  velocity.Lose();
  EXPECT_EQ(velocity.To(1.2, {0.4, 0.0, 0.0}, 0), standing);
  EXPECT_EQ(velocity.To(1.3, {0.5, 0.0, 0.0}, 1), standing);
  EXPECT_EQ(velocity.To(1.4, {1.5, 0.0, 0.0}, 1), standing);
  EXPECT_EQ(velocity.To(1.5, {1.5, 0.0, 1.0}, 1), standing);
  EXPECT_NE(velocity.To(1.6, {1.6, 0.0, 1.0}, 1), standing);
}

TEST(LaserSweep, ReadingsTakenAtOnceStayAsTheyAre) {
  const Scan scan = Swept({0.1, 0.0}, SweepOrder::kAsListed);
  EXPECT_EQ(AtStamp(scan, {}, SweepOrder::kAsListed, kVelocity), scan);
}

}  // namespace
}  // namespace depthgrid
