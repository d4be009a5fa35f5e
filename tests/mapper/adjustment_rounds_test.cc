#include "mapper/adjustment_rounds.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

std::vector<int> RoundsOf(const RoundOptions& options, int frames) {
  AdjustmentRounds rounds(options);
  std::vector<int> due;
  for (int i = 1; i <= frames; ++i) {
    if (rounds.BeginIfDue(i)) due.push_back(i);
  }
  return due;
}

TEST(AdjustmentRounds, ComeAfterTheFirstFramesAndThenRarer) {
  EXPECT_EQ(RoundsOf({.first_frames = 10, .growth = 3.0}, 300),
            (std::vector<int>{10, 30, 90, 270}));
  EXPECT_TRUE(RoundsOf({.first_frames = 0}, 300).empty());
  EXPECT_EQ(RoundsOf({.first_frames = 10, .growth = 3.0, .last_frames = 90}, 300),
            (std::vector<int>{10, 30, 90}));
}

// To and fro before a wall with a niche: a perfect prior and noisy scans.
double MeanOnlineErrorM(int first_frames) {
  PlanarWorld world = RectangleWorld(-3, -2.5, 3, 2.5);
  for (const Wall& wall : RectangleWorld(2.0, -0.4, 2.8, 0.5)) world.push_back(wall);
  MapperOptions options;
  options.rounds.first_frames = first_frames;
  options.surfel.moving_m = 0.0;  // the niche is matched from the start, before it is seen to stand
  IncrementalMapper mapper(options, std::nullopt);
  constexpr int kFrames = 240;
  double sum_m = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    const double phase_rad = 2.0 * kPi * i / kFrames;
    const Pose2 truth{0.6 * std::sin(phase_rad), 0.4 * std::sin(2.0 * phase_rad),
                      0.6 * std::sin(3.0 * phase_rad)};
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera = CameraOf(truth, 0.0);
    frame.scan = std::make_shared<Scan>(
        ScanOf(world, truth, {.sigma_of_range = 0.03}, 5, static_cast<std::uint32_t>(i)));
    const FrameReport report = mapper.AddFrame(frame);
    sum_m += (BaseOf(*report.map_from_camera).translation() - truth.translation()).norm();
  }
  return sum_m / kFrames;
}

TEST(AdjustmentRounds, PutRightWhatTheFirstFramesDrewCrookedly) {
  EXPECT_LT(MeanOnlineErrorM(60), 0.6 * MeanOnlineErrorM(0));
}

}  // namespace
}  // namespace depthgrid
