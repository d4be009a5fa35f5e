// A loop that SLAM closes after it was lost and came back in a world of its own.
#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

Pose2 RoundTheTable(int frame) {
  const double angle_rad = 2.0 * kPi * frame / 240;
  return {3.0 + 0.7 * std::cos(angle_rad), 1.7 + 0.7 * std::sin(angle_rad),
          WrapAngle(angle_rad + 0.5 * kPi)};
}

// Until SLAM closes a loop: then it is known where the part seen since the loss lies.
TEST(LoopAfterLoss, EndsTheGuess) {
  constexpr int kLost = 240, kBack = 330, kLoopAt = 460, kFrames = 500;
  const auto turned = [](int frame) { return RoundTheTable(frame) * Pose2{0.0, 0.0, kPi}; };
  for (const bool gives_up : {false, true}) {
    MapperOptions options;
    options.loops.relocation.most_searches = gives_up ? 1 : 1000;
    options.loops.relocation.min_score = 1.0;  // none is found
    IncrementalMapper mapper(options, std::nullopt);
    for (int i = 0; i < kFrames; ++i) {
      // Half of the room is behind the camera, and is seen only then.
      const Pose2 truth = i < kLost ? RoundTheTable(i) : turned(i);
      Frame frame;
      frame.index = i;
      frame.stamp_s = i / 30.0;
      const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
      frame.scan = std::make_shared<const Scan>(
          ScanOf(FurnishedRoom(), truth, laser, 4, static_cast<std::uint32_t>(i)));
      const Pose2 off = i < kBack ? Pose2{} : Pose2{4.0, 1.0, 0.9};
      frame.slam_epoch = i < kBack ? 0 : 1;
      if (i < kLost || i >= kBack) frame.slam_from_camera = CameraOf(off * truth, 1.0);
      if (i == kLoopAt) {
        LoopClosure loop;
        loop.reported_at_frame = loop.second_frame = i;
        loop.first_frame = (i + 120) % 240;  // across the table, looking the same way
        loop.first_from_second =
            Between(CameraOf(RoundTheTable(loop.first_frame), 1.0), CameraOf(truth, 1.0));
        frame.loops = {loop};
      }
      const FrameReport report = mapper.AddFrame(frame);
      if (i == kLoopAt) {
        EXPECT_EQ(report.loops_accepted, 1);
      }
      if (i >= kBack) {
        ASSERT_EQ(report.guessed, i < kLoopAt) << i;
      }
    }
  }
}

// SLAM closes a loop, and begins an epoch, at frames whose images are lost.
TEST(LoopWithoutImage, IsTakenWithTheNextImage) {
  constexpr int kLoopAt = 240, kFrames = 280;
  const Pose2 drift{0.15, -0.1, 0.05};
  for (const int lost : {0, 1, 3}) {
    IncrementalMapper mapper({}, std::nullopt);
    int rejected = 0;
    for (int i = 0; i < kFrames; ++i) {
      Frame frame;
      frame.index = i;
      frame.stamp_s = i / 30.0;
      const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
      const Pose2 truth = RoundTheTable(i);
      if (i < kLoopAt || i >= kLoopAt + lost) {
        frame.scan = std::make_shared<const Scan>(
            ScanOf(FurnishedRoom(), truth, laser, 4, static_cast<std::uint32_t>(i)));
      }
      frame.slam_epoch = i < kLoopAt ? 0 : 1;
      frame.slam_from_camera = CameraOf(i < kLoopAt ? truth : drift * truth, 1.0);
      if (i == kLoopAt) {
        LoopClosure loop;
        loop.reported_at_frame = loop.second_frame = i;
        loop.first_from_second = Between(CameraOf(RoundTheTable(0), 1.0), CameraOf(truth, 1.0));
        frame.loops = {loop};
      }
      const FrameReport report = mapper.AddFrame(frame);
      EXPECT_EQ(report.loops_accepted, i == kLoopAt + lost ? 1 : 0) << lost << ' ' << i;
      rejected += report.loops_rejected;
    }
    EXPECT_EQ(rejected, 0) << lost;
    EXPECT_FALSE(mapper.Finish().loops.empty()) << lost;
  }
}

// The other half of a room, never seen before, and a loop with its first frame.
TEST(LoopAfterLoss, OfTheVeryFrameLeavesNoGuess) {
  constexpr int kBack = 90, kFrames = 120;
  for (const bool with_loop : {false, true}) {
    MapperOptions options;
    options.loops.verify = false;  // the two see nothing in common
    IncrementalMapper mapper(options, std::nullopt);
    for (int i = 0; i < kFrames; ++i) {
      const bool is_back = i >= kBack;
      const Pose2 truth{3.0 + 0.3 * std::sin(0.05 * i), 1.7, is_back ? kPi : 0.0};
      Frame frame;
      frame.index = i;
      frame.stamp_s = i / 30.0 + (is_back ? 5.0 : 0.0);
      frame.slam_epoch = is_back ? 1 : 0;
      frame.slam_from_camera = CameraOf((is_back ? Pose2{4.0, 1.0, 0.9} : Pose2{}) * truth, 1.0);
      const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
      frame.scan = std::make_shared<const Scan>(
          ScanOf(FurnishedRoom(), truth, laser, 4, static_cast<std::uint32_t>(i)));
      if (with_loop && i == kBack) {
        LoopClosure loop;
        loop.reported_at_frame = loop.second_frame = i;
        loop.first_from_second = Between(CameraOf(Pose2{3.0, 1.7, 0.0}, 1.0), CameraOf(truth, 1.0));
        frame.loops = {loop};
      }
      const FrameReport report = mapper.AddFrame(frame);
      if (i == kBack) {
        EXPECT_EQ(report.loops_accepted, with_loop ? 1 : 0);
      }
      ASSERT_EQ(report.guessed, is_back && !with_loop) << i;
    }
  }
}

}  // namespace
}  // namespace depthgrid
