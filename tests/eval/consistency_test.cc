#include "eval/run/consistency.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"

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

FrameReport ReportAt(int index, const Pose2& estimate, int motion_from) {
  FrameReport report;
  report.index = index;
  report.stamp_s = 0.1 * index;
  report.map_from_camera = CameraOf(estimate, 0.0);
  report.motion_from = motion_from;
  report.motion_covariance = Eigen::Vector3d(1e-4, 4e-4, 1e-6).asDiagonal();
  return report;
}

TEST(MotionSamples, WorkedByHand) {
  // Stretches 0 to 2 and 2 to 4; the frame after a correction, 5, goes on from nowhere, and 6 does
  // not end its stretch.
  const std::vector<int> from = {0, 0, 0, 2, 2, 5, 5};
  // The estimate is shifted and turned, which no motion shows; from frame 1 on it is 2 cm ahead, to
  // the left and turned by 3 mrad.
  const Pose2 shift{5.0, -2.0, 1.0};
  std::vector<FrameReport> reports;
  Trajectory truth;
  for (int i = 0; i < 7; ++i) {
    const Pose2 pose{0.0, 0.1 * i, 0.5};
    const Pose2 ahead = i == 0 ? Pose2{} : Pose2{0.02, 0.02, 0.003};
    reports.push_back(ReportAt(i, shift * pose * ahead, from[static_cast<std::size_t>(i)]));
    truth.push_back({0.1 * i, CameraOf(pose, 0.0)});
  }
  std::vector<ChiSquareSample> samples = MotionSamples(reports, truth);
  ASSERT_EQ(samples.size(), 1U);  // that of 2 to 4 ends in a correction
  EXPECT_EQ(samples[0].degrees, 3);
  EXPECT_NEAR(samples[0].value, 4e-4 / 1e-4 + 4e-4 / 4e-4 + 9e-6 / 1e-6, 0.05);
  reports[5].motion_from = 4;
  reports[6].motion_from = 4;
  samples = MotionSamples(reports, truth);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_NEAR(samples[1].value, 0.0, 0.01);  // only the 3 mrad turn 0.2 m of way
  // What is not known to be true says nothing, nor what is not tracked.
  truth.erase(truth.begin() + 2);
  EXPECT_TRUE(MotionSamples(reports, truth).empty());
}

TEST(MotionSamples, LeaveOutWhatIsNotTracked) {
  std::vector<FrameReport> reports;
  Trajectory truth;
  for (int i = 0; i < 3; ++i) {
    reports.push_back(ReportAt(i, {}, i == 0 ? 0 : i - 1));
    reports.back().motion_covariance.setZero();
    truth.push_back({0.1 * i, CameraOf({}, 0.0)});
  }
  EXPECT_TRUE(MotionSamples(reports, truth).empty());
  for (FrameReport& report : reports) report.motion_from = -1;
  EXPECT_TRUE(MotionSamples(reports, truth).empty());
}

}  // namespace
}  // namespace depthgrid
