#include "eval/consistency.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depthgrid {
namespace {

TEST(DirectionsSeen, CountsWhatTheMatchKnows) {
  MatchResult match;
  EXPECT_EQ(DirectionsSeen(match), 0);
  match.information = Eigen::Vector3d(0.0, 1e4, 1e5).asDiagonal();  // along a corridor
  EXPECT_EQ(DirectionsSeen(match), 2);
  match.information(0, 0) = 10.0;
  EXPECT_EQ(DirectionsSeen(match), 3);
}

TEST(InnovationSamples, AreThoseOfFramesThatMatched) {
  FrameReport lost;
  FrameReport matched;
  matched.match.found = true;
  matched.match.information = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
  matched.innovation_chi2 = 2.5;
  const std::vector<ChiSquareSample> samples = InnovationSamples({lost, matched});
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].value, 2.5);
  EXPECT_EQ(samples[0].degrees, 3);
}

TEST(RelativeMotionSamples, WorkedByHand) {
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  // Both estimates are shifted and turned alike: only the last 3 cm and 4 mrad are errors.
  const Pose2 shift{5.0, -2.0, 1.0};
  std::vector<JudgedPose> poses;
  for (int i = 0; i < 4; ++i) {
    const Pose2 truth{0.0, 0.1 * i, 0.5};
    poses.push_back({truth, shift * truth, covariance});
  }
  poses[2].estimate = poses[2].estimate * Pose2{0.03, 0.0, 0.004};
  const std::vector<ChiSquareSample> samples = RelativeMotionSamples(poses, 2);
  ASSERT_EQ(samples.size(), 1U);  // 0 to 2; 2 to 4 is not there
  EXPECT_EQ(samples[0].degrees, 3);
  // The first pose's heading is worth 0.2 m sideways here: with m the motion from 0 to 2,
  // variances 2e-4 + m^2 1e-6. The error is forward, where the motion's sideways part counts.
  const Pose2 motion = Between(poses[0].estimate, poses[2].estimate);
  Eigen::Matrix3d by_before = Eigen::Matrix3d::Identity();
  const double c = std::cos(motion.yaw_rad);
  const double s = std::sin(motion.yaw_rad);
  by_before << c, s, s * motion.x_m - c * motion.y_m,  //
      -s, c, c * motion.x_m + s * motion.y_m,          //
      0, 0, 1;
  const Eigen::Matrix3d sum = by_before * covariance * by_before.transpose() + covariance;
  const Eigen::Vector3d error = Between(motion, Between(poses[0].truth, poses[2].truth)).vector();
  EXPECT_NEAR(error.head<2>().norm(), 0.03, 1e-9);
  EXPECT_NEAR(samples[0].value, error.dot(sum.inverse() * error), 1e-9);
  EXPECT_NEAR(samples[0].value, 0.0009 / 2e-4 + 1.6e-5 / 2e-6, 1.5);
}

TEST(RelativeMotionSamples, LeaveOutWhatIsNotTracked) {
  std::vector<JudgedPose> poses(3);
  for (JudgedPose& pose : poses) pose.covariance.setZero();
  EXPECT_TRUE(RelativeMotionSamples(poses, 1).empty());
}

}  // namespace
}  // namespace depthgrid
