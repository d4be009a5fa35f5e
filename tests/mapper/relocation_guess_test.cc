// SLAM that is right after a loss whose end shows little of what was seen before.
#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr int kGuessLost = 120, kGuessBack = 210, kGuessFrames = 330;

// Looks round in a room, and on to the rest of it once the poses are back.
Pose2 LooksRound(int frame) {
  const double turned =
      frame < kGuessLost ? 1.6 * frame / kGuessLost : 2.1 + 1.6 * (frame - kGuessBack) / 120.0;
  return {2.4 + 0.4 * std::sin(turned), 1.9, WrapAngle(turned - 1.2)};
}

struct GuessRun {
  int guessed = 0;
  int relocated = 0;
  bool guessed_at_end = false;
};

// `off`: SLAM's error after the loss.
GuessRun LoseFor3S(const Pose2& off) {
  const PlanarWorld room = FurnishedRoom();
  const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.005};
  IncrementalMapper mapper({}, std::nullopt);
  GuessRun run;
  for (int i = 0; i < kGuessFrames; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    const Pose2 truth = LooksRound(i);
    frame.scan =
        std::make_shared<const Scan>(ScanOf(room, truth, laser, 4, static_cast<std::uint32_t>(i)));
    if (i < kGuessLost) frame.slam_from_camera = CameraOf(truth, 1.0);
    if (i >= kGuessBack) frame.slam_from_camera = CameraOf(off * truth, 1.0);
    const FrameReport report = mapper.AddFrame(frame);
    run.guessed += report.guessed ? 1 : 0;
    run.relocated += report.relocated ? 1 : 0;
  }
  run.guessed_at_end = !mapper.Finish().guessed.empty();
  return run;
}

TEST(RelocationGuess, IsConfirmedByTheLittleThatIsSeenAgain) {
  const GuessRun run = LoseFor3S({});
  EXPECT_GT(run.guessed, 0);
  EXPECT_LT(run.guessed, kGuessFrames - kGuessBack);
  EXPECT_EQ(run.relocated, 0);
  EXPECT_FALSE(run.guessed_at_end);
}

TEST(RelocationGuess, ThatIsWrongIsNot) {
  for (const Pose2& off : {Pose2{0.6, 0.3, 0.0}, {-0.8, 0.4, 0.3}}) {
    EXPECT_TRUE(LoseFor3S(off).guessed_at_end) << off.x_m;
  }
}

}  // namespace
}  // namespace depthgrid
