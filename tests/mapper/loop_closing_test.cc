#include "mapper/loop_closing.h"

#include <gtest/gtest.h>

#include "mapper/core/error.h"
#include "mapper/paper_reference.h"
#include "tests/mapper/match_world.h"
#include "tests/mapper/poses.h"

namespace depthgrid {
namespace {

// Twice round a furnished room at true poses.
std::vector<MappedFrame> TwoRounds(const PlanarWorld& world, int frames_a_round) {
  ScanArchive archive;
  std::vector<MappedFrame> frames;
  for (int i = 0; i < 2 * frames_a_round; ++i) {
    const double angle_rad = 2.0 * kPi * i / frames_a_round;
    MappedFrame frame;
    frame.frame = i;
    frame.stamp_s = i / 30.0;
    frame.map_from_base = {3.0 + 0.8 * std::cos(angle_rad), 1.5 + 0.8 * std::sin(angle_rad),
                           WrapAngle(angle_rad)};
    PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
    frame.scan =
        archive.Keep(ScanOf(world, frame.map_from_base, laser, 1, static_cast<std::uint32_t>(i)));
    frames.push_back(frame);
  }
  return frames;
}

PlanarLoop LoopBetween(const std::vector<MappedFrame>& frames, int first, int second,
                       const Pose2& error) {
  PlanarLoop loop;
  loop.first = first;
  loop.second = second;
  loop.first_from_second = Between(frames[static_cast<std::size_t>(first)].map_from_base,
                                   frames[static_cast<std::size_t>(second)].map_from_base) *
                           error;
  return loop;
}

TEST(Overlap, TellsTrueLoopsFromFalseOnes) {
  const std::vector<MappedFrame> frames = TwoRounds(FurnishedRoom(), 150);
  RandomStream random(1, RandomStage::kTest);
  int true_loops = 0, true_accepted = 0, false_loops = 0, false_accepted = 0;
  for (int i = 0; i < 40; ++i) {
    const int first = static_cast<int>(random.Below(150));
    const Pose2 noise{0.02 * random.Normal(), 0.02 * random.Normal(), 0.01 * random.Normal()};
    const OverlapOptions options;
    ++true_loops;
    true_accepted +=
        Agrees(OverlapOf(frames, LoopBetween(frames, first, first + 145, noise), options), options);
    // Another place altogether, or the right one displaced.
    PlanarLoop wrong = LoopBetween(frames, first, 150 + static_cast<int>(random.Below(150)), {});
    wrong.first_from_second = {random.Uniform(-1, 1), random.Uniform(-1, 1),
                               random.Uniform(-0.6, 0.6)};
    const Pose2 far{0.4, random.Uniform(0.3, 0.6), 0.2};
    for (const PlanarLoop& loop : {wrong, LoopBetween(frames, first, first + 145, far)}) {
      ++false_loops;
      false_accepted += Agrees(OverlapOf(frames, loop, options), options);
    }
  }
  EXPECT_EQ(true_loops, 40);
  EXPECT_GE(true_accepted, 39);
  EXPECT_EQ(false_loops, 80);
  EXPECT_LE(false_accepted, 4);
}

Frame PosedFrame(int index, const Pose2& slam_from_base, int epoch) {
  Frame frame;
  frame.index = index;
  frame.slam_epoch = epoch;
  frame.slam_from_camera = CameraOf(slam_from_base, 1.15);
  return frame;
}

LoopClosure CameraLoop(int first, int second, const Pose2& first_from_second) {
  LoopClosure loop;
  loop.first_frame = first;
  loop.second_frame = second;
  loop.first_from_second = Between(CameraOf({}, 1.15), CameraOf(first_from_second, 1.15));
  return loop;
}

TEST(ProjectLoop, JoinsMappedFramesDirectly) {
  FrameHistory history;
  for (int i = 0; i < 5; ++i) {
    history.Start(PosedFrame(i, {0.1 * i, 0, 0}, 0));
    history.newest().mapped = i;
  }
  const Pose2 measured{0.3, -0.2, 0.1};
  const auto loop = ProjectLoop(CameraLoop(0, 3, measured), history, -1);
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->first, 0);
  EXPECT_EQ(loop->second, 3);
  ExpectNear(loop->first_from_second, measured, 1e-12);
  // The newest frame, which is about to be mapped.
  history.Start(PosedFrame(5, {0.5, 0, 0}, 1));
  EXPECT_FALSE(ProjectLoop(CameraLoop(0, 5, measured), history, -1));
  const auto provisional = ProjectLoop(CameraLoop(0, 5, measured), history, 5);
  ASSERT_TRUE(provisional);
  EXPECT_EQ(provisional->second, 5);
}

TEST(ProjectLoop, MovesToTheNearestMappedFrameWithinAnEpoch) {
  const std::vector<Pose2> slam = {{0, 0, 0}, {0.1, 0, 0.1}, {0.2, 0.1, 0.2}, {0.3, 0.1, 0.3}};
  // Only frame 1 of the first epoch and frame 3 of the second are mapped.
  FrameHistory history;
  for (int i = 0; i < 4; ++i) {
    history.Start(PosedFrame(i, slam[static_cast<std::size_t>(i)], i / 3));
    if (i == 1) history.newest().mapped = 0;
    if (i == 3) history.newest().mapped = 1;
  }
  const Pose2 measured{0.5, 0.1, -0.2};
  const auto loop = ProjectLoop(CameraLoop(2, 3, measured), history, -1);
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->first, 0);
  ExpectNear(loop->first_from_second, Between(slam[1], slam[2]) * measured, 1e-12);
  // Both ends at one mapped frame say nothing.
  EXPECT_FALSE(ProjectLoop(CameraLoop(0, 2, measured), history, -1));
  EXPECT_FALSE(ProjectLoop(CameraLoop(0, 17, measured), history, -1));
}

// The loop's end that is not mapped is the later one.
TEST(ProjectLoop, SoDoesItsSecondEnd) {
  const std::vector<Pose2> slam = {{0, 0, 0}, {0.1, 0, 0.1}, {0.2, 0.1, 0.2}};
  FrameHistory history;
  for (int i = 0; i < 3; ++i) {
    history.Start(PosedFrame(i, slam[static_cast<std::size_t>(i)], 0));
    if (i < 2) history.newest().mapped = i;
  }
  const Pose2 measured{0.5, 0.1, -0.2};
  const auto loop = ProjectLoop(CameraLoop(0, 2, measured), history, -1);
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->second, 1);
  ExpectNear(loop->first_from_second, measured * Between(slam[2], slam[1]), 1e-12);
}

// SLAM begins an epoch at a frame without an image: the next mapped one of that epoch stands in.
TEST(ProjectLoop, WaitsForTheFirstMappedFrameOfAnEpoch) {
  const std::vector<Pose2> slam = {{0, 0, 0}, {0.1, 0, 0.1}, {0.2, 0.1, 0.2}, {0.3, 0.1, 0.3}};
  const Pose2 measured{0.5, 0.1, -0.2};
  const LoopClosure event = CameraLoop(0, 2, measured);
  FrameHistory history;
  for (int i = 0; i < 3; ++i) {
    history.Start(PosedFrame(i, slam[static_cast<std::size_t>(i)], i / 2));
    if (i < 2) history.newest().mapped = i;
  }
  EXPECT_FALSE(ProjectLoop(event, history, -1));
  EXPECT_TRUE(MayBeProjectedLater(event, history));
  EXPECT_FALSE(MayBeProjectedLater(CameraLoop(0, 1, measured), history));   // it can be now
  EXPECT_FALSE(MayBeProjectedLater(CameraLoop(0, 17, measured), history));  // never came
  history.Start(PosedFrame(3, slam[3], 1));
  const auto loop = ProjectLoop(event, history, 2);
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->second, 2);
  ExpectNear(loop->first_from_second, measured * Between(slam[2], slam[3]), 1e-12);
}

TEST(ProjectLoop, WaitsForThirtyFrames) {
  FrameHistory history;
  history.Start(PosedFrame(0, {}, 0));
  history.newest().mapped = 0;
  const LoopClosure event = CameraLoop(0, 1, {0.5, 0.0, 0.0});
  for (int i = 1; i < 40; ++i) {
    history.Start(PosedFrame(i, {0.1 * i, 0.0, 0.0}, 1));
    EXPECT_EQ(MayBeProjectedLater(event, history), i <= 30) << i;
    EXPECT_EQ(ProjectLoop(event, history, 1).has_value(), i <= 31) << i;
  }
}

// A new epoch ends the waiting: no motion leads from there to the loop's frame.
TEST(ProjectLoop, DoesNotWaitBeyondTheEpoch) {
  FrameHistory history;
  history.Start(PosedFrame(0, {}, 0));
  history.newest().mapped = 0;
  history.Start(PosedFrame(1, {}, 1));
  history.Start(PosedFrame(2, {}, 2));
  EXPECT_FALSE(MayBeProjectedLater(CameraLoop(0, 1, {0.5, 0.0, 0.0}), history));
}

TEST(FrameHistory, RefusesAnIndexTwice) {
  FrameHistory history;
  history.Start(PosedFrame(3, {}, 0));
  EXPECT_THROW(history.Start(PosedFrame(3, {}, 0)), InputError);
}

TEST(Extrapolated, GoesOnAsItWentUnlessTheStampsTellNoSpeed) {
  const auto forward_m = [](double second_s, double third_s) {
    FrameHistory history;
    for (int i = 0; i < 3; ++i) {
      Frame frame = PosedFrame(i, {0.1 * i, 0, 0}, i / 2);
      frame.stamp_s = i == 0 ? 0.0 : i == 1 ? second_s : third_s;
      history.Start(frame);
    }
    return Extrapolated(history, {}).map_from_base.x_m;
  };
  EXPECT_NEAR(forward_m(0.1, 0.2), 0.2, 1e-12);
  EXPECT_NEAR(forward_m(0.1, 0.25), 0.25, 1e-12);
  EXPECT_EQ(forward_m(0.1, 0.7), 0.1);   // too long ago
  EXPECT_EQ(forward_m(0.0, 0.1), 0.1);   // no time between the first two
  EXPECT_EQ(forward_m(0.0, 0.0), 0.1);   // nor after
  EXPECT_EQ(forward_m(1e-7, 0.1), 0.1);  // or as good as none
  EXPECT_EQ(forward_m(-0.1, 0.1), 0.1);
  EXPECT_EQ(forward_m(0.1, 0.05), 0.1);
}

TEST(FinalPoses, UnmappedFramesFollowTheNearestMappedOne) {
  FrameHistory history;
  for (int i = 0; i < 5; ++i) {
    history.Start(PosedFrame(i, {0.1 * i, 0, 0}, i / 4));
    if (i == 1) history.newest().mapped = 0;
  }
  const auto poses = FinalPoses(history, {{0.1, 0.3, 0.0}}, StandBlend(0.0));
  ASSERT_EQ(poses.size(), 5U);
  for (int i = 0; i < 4; ++i) {
    ExpectNear(BaseOf(*poses[static_cast<std::size_t>(i)]), {0.1 * i, 0.3, 0.0}, 1e-12);
  }
  ExpectNear(BaseOf(*poses[4]), {0.4, 0.0, 0.0},
             1e-12);  // another epoch: the correction known then
}

// Ten seconds after the last mapped frame its correction is no better than the one of the time.
TEST(FinalPoses, UnlessThatIsTenSecondsAway) {
  FrameHistory history;
  for (int i = 0; i < 303; ++i) {
    history.Start(PosedFrame(i, {0.1 * i, 0, 0}, 0));
    if (i == 1) history.newest().mapped = 0;
  }
  const auto poses = FinalPoses(history, {{0.1, 0.3, 0.0}}, StandBlend(0.0));
  ExpectNear(BaseOf(*poses[301]), {30.1, 0.3, 0.0}, 1e-9);
  ExpectNear(BaseOf(*poses[302]), {30.2, 0.0, 0.0}, 1e-9);
}

}  // namespace
}  // namespace depthgrid
