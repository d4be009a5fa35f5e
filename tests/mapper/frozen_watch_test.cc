#include "mapper/scan/frozen_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/mapper/prior_round.h"

namespace depthgrid {
namespace {

constexpr int kHangs = 100;   // the last frame with a scan of its own
constexpr int kGoesOn = 180;  // the next one
constexpr int kFrozenEnd = 260;

Frame HungFrameAt(int i, const Pose2& slam_from_base, bool hangs = true) {
  Frame frame = PriorFrameAt(i, slam_from_base);
  if (hangs && i > kHangs && i < kGoesOn) {
    frame.scan = std::make_shared<Scan>(PriorScanAt(kHangs, 2));
  }
  return frame;
}

std::vector<bool> FrozenOf(const std::vector<Frame>& frames) {
  FrozenWatch watch;
  std::vector<bool> frozen;
  for (const Frame& frame : frames) frozen.push_back(watch.IsFrozen(frame));
  return frozen;
}

TEST(FrozenWatch, TellsAScanThatStaysWhileTheRobotDrives) {
  std::vector<Frame> frames;
  for (int i = 0; i < kFrozenEnd; ++i) frames.push_back(HungFrameAt(i, PriorTruthAt(i)));
  const std::vector<bool> frozen = FrozenOf(frames);
  for (int i = 0; i < kFrozenEnd; ++i) {
    // 1.7 cm and 1.2 degrees a frame.
    if (i <= kHangs + 1 || i >= kGoesOn) {
      EXPECT_FALSE(frozen[static_cast<std::size_t>(i)]) << i;
    }
    if (i >= kHangs + 3 && i < kGoesOn) {
      EXPECT_TRUE(frozen[static_cast<std::size_t>(i)]) << i;
    }
  }
}

TEST(FrozenWatch, TellsNothingOfARobotThatStands) {
  std::vector<Frame> frames;
  for (int i = 0; i < kFrozenEnd; ++i) {
    // Odometry creeps by 3 cm/s, as of a robot that trembles.
    const Pose2 crept = PriorTruthAt(kHangs) * Pose2{1e-3 * std::max(i - kHangs, 0), 0.0, 0.0};
    frames.push_back(HungFrameAt(i, i < kHangs ? PriorTruthAt(i) : crept));
    if (i >= kGoesOn) frames.back().scan = frames[kHangs + 1].scan;  // the same object
  }
  const std::vector<bool> frozen = FrozenOf(frames);
  EXPECT_EQ(std::count(frozen.begin(), frozen.end(), true), 0);
}

TEST(FrozenWatch, DoesNotCompareAcrossEpochsAndWithoutPoses) {
  std::vector<Frame> frames = {PriorFrameAt(0, PriorTruthAt(0)), PriorFrameAt(1, PriorTruthAt(50)),
                               PriorFrameAt(2, PriorTruthAt(50)),
                               PriorFrameAt(3, PriorTruthAt(100))};
  for (Frame& frame : frames) frame.scan = frames[0].scan;
  EXPECT_EQ(FrozenOf(frames), (std::vector<bool>{false, true, true, true}));
  for (std::size_t i = 1; i < frames.size(); ++i) frames[i].slam_epoch = 1;
  EXPECT_EQ(FrozenOf(frames), (std::vector<bool>{false, false, false, true}));
  frames[3].slam_from_camera.reset();
  EXPECT_EQ(FrozenOf(frames), (std::vector<bool>{false, false, false, false}));
}

// The estimate goes on by odometry, which turns by 2.8 degrees too much meanwhile. Were the hung
// scan matched, it would be 1.2 m off then and ever after.
TEST(FrozenWatch, AHungDriverDoesNotHoldTheEstimateBack) {
  IncrementalMapper mapper({}, std::nullopt);
  const std::vector<Pose2> slam_from_base = DriftedRound();
  double hung_m = 0.0, after_m = 0.0;
  for (int i = 0; i < kFrozenEnd; ++i) {
    const FrameReport report =
        mapper.AddFrame(HungFrameAt(i, slam_from_base[static_cast<std::size_t>(i)]));
    EXPECT_FALSE(report.carried) << i;
    const bool is_hung = i > kHangs && i < kGoesOn;
    const double error_m = PriorErrorM(BaseOf(*report.map_from_camera), PriorTruthAt(i));
    double& worst_m = is_hung ? hung_m : after_m;
    if (i > kHangs) worst_m = std::max(worst_m, error_m);
    if (is_hung && i > kHangs + 3) {
      EXPECT_EQ(report.beams, 0) << i;
    }
  }
  EXPECT_LT(hung_m, 0.05);
  EXPECT_LT(after_m, 0.2);
}

// Noise never repeats, so nothing may change where no scan does.
TEST(FrozenWatch, ChangesNothingWhereScansDiffer) {
  std::vector<Frame> frames;
  for (int i = 0; i < kFrozenEnd; ++i) frames.push_back(HungFrameAt(i, PriorTruthAt(i), false));
  const std::vector<bool> frozen = FrozenOf(frames);
  EXPECT_EQ(std::count(frozen.begin(), frozen.end(), true), 0);
}

}  // namespace
}  // namespace depthgrid
