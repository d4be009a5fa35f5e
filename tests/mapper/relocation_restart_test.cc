// SLAM that is lost for less than two seconds and begins anew, or jumps untold, no farther than a
// robot may have gone.
#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

Pose2 RoundTheTables(int frame) {
  const double angle_rad = 2.0 * kPi * frame / 240;
  return {3.0 + 0.7 * std::cos(angle_rad), 1.7 + 0.7 * std::sin(angle_rad),
          WrapAngle(angle_rad + 0.5 * kPi)};
}

struct RestartedRun {
  double worst_m = 0.0;  // since the loss, at the end
  bool first_guessed = false;
  bool last_guessed = false;
};

// Once round a room, then frames without poses, then SLAM's world is moved by `jump` about the
// camera; `told`: in a new epoch.
RestartedRun RestartAfter(int lost_frames, const Pose2& jump, bool told = true) {
  constexpr int kLost = 260, kFrames = 420;
  const int back = kLost + lost_frames;
  const PlanarWorld room = FurnishedRoom();
  IncrementalMapper mapper({}, std::nullopt);
  const Pose2 at = RoundTheTables(back);
  RestartedRun run;
  for (int i = 0; i < kFrames; ++i) {
    const Pose2 truth = RoundTheTables(i);
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
    frame.scan =
        std::make_shared<const Scan>(ScanOf(room, truth, laser, 4, static_cast<std::uint32_t>(i)));
    frame.slam_epoch = told && i >= back ? 1 : 0;
    if (i < kLost) frame.slam_from_camera = CameraOf(truth, 1.0);
    if (i >= back) frame.slam_from_camera = CameraOf(at * jump * Between(at, truth), 1.0);
    const FrameReport report = mapper.AddFrame(frame);
    if (i == back) run.first_guessed = report.guessed;
    run.last_guessed = report.guessed;
  }
  const MapperResult result = mapper.Finish();
  for (int i = back; i < kFrames; ++i) {
    const Pose2 pose = BaseOf(*result.map_from_camera[static_cast<std::size_t>(i)]);
    run.worst_m =
        std::max(run.worst_m, (pose.translation() - RoundTheTables(i).translation()).norm());
  }
  return run;
}

TEST(RelocationRestart, AShortLossAndASmallJumpAreSearchedFor) {
  for (const int lost_frames : {9, 21, 40}) {
    const RestartedRun run = RestartAfter(lost_frames, {0.1, 0.6, 0.2});
    // Up to half a second the last motion leads to where the map explains the scan.
    EXPECT_EQ(run.first_guessed, lost_frames > 15) << lost_frames;
    EXPECT_FALSE(run.last_guessed) << lost_frames;
    EXPECT_LT(run.worst_m, 0.02) << lost_frames;
  }
}

// The scan contradicts the map there.
TEST(RelocationRestart, AJumpThatNobodyTellsIsNoticed) {
  for (const int lost_frames : {9, 21, 40}) {
    const RestartedRun run = RestartAfter(lost_frames, {0.1, 0.6, 0.2}, false);
    EXPECT_FALSE(run.last_guessed) << lost_frames;
    EXPECT_LT(run.worst_m, 0.02) << lost_frames;
  }
}

TEST(RelocationRestart, WhatTheMapExplainsIsNoGuess) {
  const RestartedRun run = RestartAfter(21, {0.02, -0.02, 0.01});
  EXPECT_FALSE(run.first_guessed);
  EXPECT_LT(run.worst_m, 0.02);
}

}  // namespace
}  // namespace depthgrid
