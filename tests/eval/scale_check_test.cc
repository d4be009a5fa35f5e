#include "eval/doubts/scale_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

// A camera that drives 5 cm a frame around squares of 2 m in the map; SLAM's motions are what
// `slam_of` makes of the map's.
MappingRun AroundSquares(int frames, const std::function<Pose2(int, const Pose2&)>& slam_of) {
  constexpr int kFramesASide = 40;
  MappingRun run;
  run.camera.emplace();
  Pose2 slam, map;
  for (int i = 0; i < frames; ++i) {
    FrameReport report;
    report.stamp_s = 0.1 * i;
    report.slam_from_camera = CameraOf(slam, 0.0);
    run.reports.push_back(report);
    run.result.map_from_camera.emplace_back(CameraOf(map, 0.0));
    const Pose2 step{0.05, 0.0, (i + 1) % kFramesASide == 0 ? 0.5 * kPi : 0.0};
    map = map * step;
    slam = slam * slam_of(i, step);
  }
  return run;
}

// 2 mm of noise a frame: 6 mm over a stretch.
Pose2 Noisy(int frame, Pose2 step) {
  RandomStream random(static_cast<std::uint64_t>(frame), RandomStage::kTest);
  step.x_m += 0.002 * random.Normal();
  step.y_m += 0.002 * random.Normal();
  return step;
}

MappingRun Scaled(int frames, double map_over_slam) {
  return AroundSquares(frames, [=](int frame, Pose2 step) {
    step.x_m /= map_over_slam;
    return Noisy(frame, step);
  });
}

TEST(ScaleCheck, TellsAFactorOfAFewPercent) {
  for (const double ratio : {1.136, 1.08, 0.93, 0.89}) {
    const auto told = SlightScaleDoubt(Scaled(320, ratio));
    ASSERT_TRUE(told) << ratio;
    EXPECT_NEAR(told->ratio, ratio, 0.015);
    EXPECT_NEAR(told->ways.map_m / told->ways.slam_m, ratio, 0.02);
    EXPECT_GT(told->sigma, 0.0);
    EXPECT_LT(told->sigma, 0.01);
  }
}

TEST(ScaleCheck, TellsNoneOfRightScales) {
  for (const double ratio : {1.0, 1.02, 0.98}) {
    EXPECT_FALSE(SlightScaleDoubt(Scaled(320, ratio))) << ratio;
  }
  EXPECT_FALSE(SlightScaleDoubt(Scaled(60, 1.136)));  // too short to tell
  EXPECT_FALSE(SlightScaleDoubt(MappingRun{}));
}

// A SLAM whose speed is off by up to 20 % for seconds, ahead and sideways, and on the whole by 7 %.
TEST(ScaleCheck, TellsNoneOfSlamThatDrifts) {
  for (int phase = 0; phase < 8; ++phase) {
    const MappingRun run = AroundSquares(320, [=](int frame, Pose2 step) {
      const double at = 0.02 * frame + phase;
      step.x_m *= 0.93 + 0.2 * std::sin(at);
      step.y_m += 0.01 * std::cos(0.7 * at);
      return Noisy(frame, step);
    });
    EXPECT_FALSE(SlightScaleDoubt(run)) << phase;
  }
}

// Stretches whose length differs from one to the next say little about the whole.
TEST(ScaleCheck, TellsNoneOfAFewStretchesThatDiffer) {
  const MappingRun run = AroundSquares(320, [](int frame, Pose2 step) {
    if (frame > 60 && frame < 120) step.x_m *= 0.6;
    return step;
  });
  EXPECT_FALSE(SlightScaleDoubt(run));
}

}  // namespace
}  // namespace depthgrid
