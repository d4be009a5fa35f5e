// A recording that paused: SLAM's motion over the pause errs by as much as one over the frames that
// did not come.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "mapper/core/level.h"
#include "mapper/core/usual_step.h"
#include "mapper/frame_history.h"
#include "mapper/fuse/drift_tracker.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

MotionNoise NoiseOfTest() {
  MotionNoise noise;
  noise.walk.setConstant(0.3);
  noise.bias.setConstant(0.1);
  noise.bias_kept.setConstant(0.5);
  return noise;
}

TEST(UsualStepS, IsTheMedianWhichPausesDoNotMove) {
  std::vector<double> steps_s = {0.03, 5.0, 0.04, 0.02, 0.03};
  EXPECT_EQ(UsualStepS(steps_s), 0.03);
  EXPECT_EQ(UsualStepS({}), 0.0);
}

TEST(StepsIn, CountsUsualSteps) {
  EXPECT_EQ(StepsIn(0.04, 0.03), 1);
  EXPECT_EQ(StepsIn(0.06, 0.03), 2);
  EXPECT_EQ(StepsIn(-5.0, 0.03), 1);
  EXPECT_EQ(StepsIn(0.06, 0.0), 1);
  EXPECT_EQ(StepsIn(1e9, 0.03), 1000);
}

TEST(ErrorsOver, OneFrameAreTheNoiseItself) {
  const MotionErrors errors = ErrorsOver(1, NoiseOfTest());
  EXPECT_EQ(errors.walk, NoiseOfTest().walk);
  EXPECT_EQ(errors.bias_added, Eigen::Vector3d::Ones());
  EXPECT_EQ(errors.bias_kept, NoiseOfTest().bias_kept);
  EXPECT_NEAR(errors.bias_renewed.x(), 0.1 * std::sqrt(0.75), 1e-15);
}

// Two frames: b and b' = b / 2 + r, var r = 3/4 var b. Their sum is 3/2 b + r.
TEST(ErrorsOver, TwoFramesAddUp) {
  const MotionErrors errors = ErrorsOver(2, NoiseOfTest());
  EXPECT_NEAR(errors.bias_added.x(), 1.5, 1e-12);
  EXPECT_NEAR(errors.bias_kept.y(), 0.25, 1e-12);
  EXPECT_NEAR(errors.walk.z(), std::sqrt(2.0 * 0.09 + 0.75 * 0.01), 1e-12);
  EXPECT_NEAR(errors.bias_renewed.x(), 0.1 * std::sqrt(15.0 / 16.0), 1e-12);
}

TEST(ErrorsOver, ABiasThatStaysAddsAtEachFrame) {
  MotionNoise noise = NoiseOfTest();
  noise.bias_kept.setOnes();
  const MotionErrors errors = ErrorsOver(7, noise);
  EXPECT_EQ(errors.bias_added.x(), 7.0);
  EXPECT_NEAR(errors.walk.x(), 0.3 * std::sqrt(7.0), 1e-12);
}

TEST(FrameHistory, TellsForHowManyFramesARecordingPaused) {
  FrameHistory history;
  int index = 0;
  const auto frames_to = [&](double stamp_s, bool posed = true) {
    Frame frame;
    frame.index = index++;
    frame.stamp_s = stamp_s;
    if (posed) frame.slam_from_camera = CameraOf({}, 1.0);
    history.Start(frame);
    return history.FramesToNewest();
  };
  for (int i = 0; i < 20; ++i) EXPECT_EQ(frames_to(0.1 * i), 1);
  EXPECT_EQ(frames_to(2.9), 10);  // the last was at 1.9
  EXPECT_EQ(frames_to(3.0), 1);
  EXPECT_EQ(frames_to(3.5, false), 1);
  EXPECT_EQ(frames_to(4.0), 1);  // SLAM was lost
}

// The robot stood, however long: SLAM erred no more than over a few frames. A turn counts too.
TEST(FrameHistory, APauseInWhichNothingMovedIsAShortOne) {
  const auto frames_over = [](const Pose2& motion, double pause_s) {
    FrameHistory history;
    Pose2 pose;
    Frame frame;
    for (frame.index = 0; frame.index < 40; ++frame.index) {
      frame.stamp_s = 0.1 * frame.index;
      frame.slam_from_camera = CameraOf(pose, 1.0);
      history.Start(frame);
      pose = pose * Pose2{0.02, 0.0, 0.01};
    }
    frame.stamp_s += pause_s;
    frame.slam_from_camera = CameraOf(BaseOf(*history.newest().slam_from_camera) * motion, 1.0);
    history.Start(frame);
    return history.FramesToNewest();
  };
  EXPECT_EQ(frames_over({0.01, 0.0, 0.0}, 2.0), 20);
  EXPECT_EQ(frames_over({0.01, 0.0, 0.0}, 60.0), 30);
  EXPECT_NEAR(frames_over({1.0, 0.0, 0.0}, 60.0), 100, 1);
  EXPECT_NEAR(frames_over({0.0, 0.0, 1.0}, 60.0), 200, 1);
  EXPECT_EQ(frames_over({20.0, 0.0, 0.0}, 60.0), 600);
}

// Where no motion is known, or nothing moved before, the time alone tells.
TEST(MovingStepsIn, IsTheTimesWhereNothingIsUsual) {
  UsualMotion stood;
  stood.Add({});
  for (const UsualMotion& usual : {UsualMotion{}, stood}) {
    EXPECT_EQ(MovingStepsIn(500, {0.1, 0.0, 0.0}, usual), 500);
    EXPECT_EQ(MovingStepsIn(500, {}, usual), 30);
  }
}

TEST(DriftTracker, BelievesSlamsMotionOverAPauseLess) {
  DriftTracker tracker;
  MatchResult match;
  match.found = true;
  match.information = 1e10 * Eigen::Matrix3d::Identity();
  tracker.Commit({}, {}, Eigen::Matrix3d::Zero(), match);
  const double variance = tracker.Predict({0.1, 0.0, 0.0}).covariance(0, 0);
  tracker.SetFrames(25, 0.0);
  const double paused = tracker.Predict({0.1, 0.0, 0.0}).covariance(0, 0);
  EXPECT_GT(paused, 20.0 * variance);
  // The next one is one frame again.
  tracker.Commit({0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, Eigen::Matrix3d::Zero(), match);
  EXPECT_LT(tracker.Predict({0.2, 0.0, 0.0}).covariance(0, 0), 2.0 * variance);
}

// Nobody tells that the tracker went elsewhere while the recording paused for a second; no robot
// goes that far meanwhile.
TEST(Pause, AStepOverItThatNoRobotMakesIsSearchedFor) {
  constexpr int kBefore = 240, kFrames = 400;
  const PlanarWorld room = FurnishedRoom();
  const auto round_the_room = [](int frame) {
    const double angle_rad = 2.0 * kPi * frame / 240;
    return Pose2{3.0 + 0.7 * std::cos(angle_rad), 1.7 + 0.7 * std::sin(angle_rad),
                 WrapAngle(angle_rad + 0.5 * kPi)};
  };
  IncrementalMapper mapper({}, std::nullopt);
  for (int i = 0; i < kFrames; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0 + (i < kBefore ? 0.0 : 0.9);
    const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
    frame.scan = std::make_shared<const Scan>(
        ScanOf(room, round_the_room(i), laser, 4, static_cast<std::uint32_t>(i)));
    const Pose2 off = i < kBefore ? Pose2{} : Pose2{4.0, 1.0, 0.9};
    frame.slam_from_camera = CameraOf(off * round_the_room(i), 1.0);
    mapper.AddFrame(frame);
  }
  const MapperResult result = mapper.Finish();
  for (int i = kBefore; i < kFrames; ++i) {
    const Pose2 pose = BaseOf(*result.map_from_camera[static_cast<std::size_t>(i)]);
    ASSERT_LT((pose.translation() - round_the_room(i).translation()).norm(), 0.03) << i;
  }
}

}  // namespace
}  // namespace depthgrid
