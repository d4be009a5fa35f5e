// How well a motion over a new epoch's start is known (docs/math.md, "Epochs").
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

constexpr int kNewEpochFrom = 30;  // the first frame of the new epoch
constexpr double kFrameStepS = 1.0 / 30.0;

// Straight on at .6 m/s in a furnished room; from kNewEpochFrom on SLAM is 5 cm and a degree off.
std::vector<Frame> JumpingFrames() {
  const PlanarWorld room = FurnishedRoom();
  std::vector<Frame> frames;
  for (int i = 0; i < kNewEpochFrom + 5; ++i) {
    const Pose2 base{1.5 + 0.02 * i, 1.6, 0.0};
    Frame frame;
    frame.index = i;
    frame.stamp_s = i * kFrameStepS;
    frame.slam_epoch = i < kNewEpochFrom ? 0 : 1;
    const Pose2 slam = i < kNewEpochFrom ? base : Pose2{0.05, 0.02, 0.017} * base;
    frame.slam_from_camera = CameraOf(slam, 1.0);
    frame.scan = std::make_shared<Scan>(ScanOf(room, base, {}, 1, static_cast<std::uint32_t>(i)));
    frames.push_back(frame);
  }
  return frames;
}

// Of the first mapped frame from kNewEpochFrom on.
double GapShare(const std::vector<Frame>& frames) {
  IncrementalMapper mapper({}, std::nullopt);
  for (const Frame& frame : frames) mapper.AddFrame(frame);
  for (const MappedFrame& frame : mapper.CurrentMapped()) {
    if (frame.frame < kNewEpochFrom) continue;
    EXPECT_FALSE(frame.slam_motion);
    return frame.gap_share;
  }
  ADD_FAILURE() << "no frame is mapped after the jump";
  return 0.0;
}

void LoseFrames(std::vector<Frame>& frames, int count) {
  for (int i = kNewEpochFrom - count; i < kNewEpochFrom; ++i) {
    frames[static_cast<std::size_t>(i)].slam_from_camera.reset();
  }
}

TEST(EpochGap, OverOneFrameTheMotionIsKnownToMillimetres) {
  const double share = std::pow(kFrameStepS / 0.3, 2);
  EXPECT_NEAR(GapShare(JumpingFrames()), share, 1e-9);
}

TEST(EpochGap, OverSeveralItIsNot) {
  std::vector<Frame> frames = JumpingFrames();
  LoseFrames(frames, 5);
  EXPECT_DOUBLE_EQ(GapShare(frames), 1.0);
}

TEST(EpochGap, TheLongerTheLessIsKnown) {
  std::vector<Frame> frames = JumpingFrames();
  LoseFrames(frames, 20);
  EXPECT_NEAR(GapShare(frames), 21.0 * kFrameStepS / 0.3, 1e-9);
}

// SLAM corrects its poses by a loop of this frame: the camera went on as it did.
TEST(EpochGap, ALoopOfTheFrameLeavesItAsWellKnown) {
  std::vector<Frame> frames = JumpingFrames();
  Frame& back = frames[kNewEpochFrom];
  const Frame& first = frames[2];
  back.loops.push_back({.first_frame = first.index,
                        .second_frame = back.index,
                        .first_from_second = Inverse(CameraOf({1.54, 1.6, 0.0}, 1.0)) *
                                             CameraOf({2.1, 1.6, 0.0}, 1.0),
                        .sigma_translation_m = 0.01,
                        .sigma_rotation_rad = 0.005});
  EXPECT_NEAR(GapShare(frames), std::pow(kFrameStepS / 0.3, 2), 1e-9);
}

// Stamps 0.1 s apart are so but for rounding.
TEST(EpochGap, AtTenHertzOneFrameIsOneWhateverTheClockCountsFrom) {
  for (const double from_s : {0.0, 1.3e9, 1.3e9 + 0.3}) {
    std::vector<Frame> frames = JumpingFrames();
    for (Frame& frame : frames) frame.stamp_s = from_s + 0.1 * frame.index;
    EXPECT_NEAR(GapShare(frames), 1.0 / 9.0, 1e-4) << from_s;
  }
}

// SLAM is back after half a second, without an image, and jumps once more at the next frame.
TEST(EpochGap, AnEpochOfWhichNothingIsMappedCounts) {
  std::vector<Frame> frames = JumpingFrames();
  LoseFrames(frames, 15);
  frames[kNewEpochFrom].scan.reset();
  for (std::size_t i = kNewEpochFrom + 1; i < frames.size(); ++i) {
    frames[i].slam_epoch = 2;
    frames[i].slam_from_camera = ApplyPlanar({0.03, 0.0, 0.0}, *frames[i].slam_from_camera);
  }
  EXPECT_GE(GapShare(frames), 1.0);
}

// Where nothing was in reach of the sensor so far, the map knows nothing better than SLAM, which
// corrects its own drift.
TEST(EpochGap, BeforeAnythingWasMatchedTheCorrectionIsSlams) {
  for (const bool sees : {true, false}) {
    IncrementalMapper mapper({}, std::nullopt);
    Pose2 last, slam;
    for (Frame& frame : JumpingFrames()) {
      Scan scan = *frame.scan;
      for (Beam& beam : scan.beams) beam.hit = beam.hit && sees;
      frame.scan = std::make_shared<Scan>(scan);
      last = BaseOf(*mapper.AddFrame(frame).map_from_camera);
      slam = BaseOf(*frame.slam_from_camera);
    }
    const double apart_m = (last.translation() - slam.translation()).norm();
    EXPECT_EQ(apart_m > 0.04, sees) << apart_m;
    EXPECT_EQ(apart_m < 1e-9, !sees) << apart_m;
  }
}

}  // namespace
}  // namespace depthgrid
