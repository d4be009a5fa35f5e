#include "mapper/io/held_frames.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

constexpr std::size_t kHeldTestFrames = 66;

// The camera goes towards a wall at 2 cm a frame, or stands until frame 30. Noise of 1 cm.
ImageOfFrame ImagesTowardsAWall(bool stands_at_first = false) {
  return [=](std::size_t i) {
    auto image = std::make_shared<DepthImage>(64, 48);
    RandomStream random(i, RandomStage::kTest);
    const double steps =
        stands_at_first ? std::max(static_cast<double>(i), 30.0) : static_cast<double>(i);
    for (float& z_m : image->z_m) {
      z_m = static_cast<float>(5.0 - 0.02 * steps + 0.01 * random.Normal());
    }
    return image;
  };
}

// Poses as they were, but for frames from `begin` to before `end`, which have that of `begin`, or,
// at the start, of `end`.
std::vector<std::optional<Pose3>> PosesHeld(std::size_t begin, std::size_t end) {
  std::vector<std::optional<Pose3>> poses;
  for (std::size_t i = 0; i < kHeldTestFrames; ++i) {
    const std::size_t of = i >= begin && i < end ? (begin == 0 ? end - 1 : begin) : i;
    poses.push_back(
        Pose3{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.02 * static_cast<double>(of)}});
  }
  return poses;
}

TEST(HeldFrames, AreThoseWhoseImagesMoveOn) {
  const std::vector<bool> held =
      HeldFrames(PosesHeld(20, 40), 0, kHeldTestFrames, ImagesTowardsAWall());
  for (std::size_t i = 0; i < kHeldTestFrames; ++i) {
    EXPECT_EQ(held[i], i > 20 && i < 40) << i;
  }
}

// Its first frames show no motion yet, so their pose is right.
TEST(HeldFrames, AreNotThoseOfAStandBefore) {
  const std::vector<bool> held =
      HeldFrames(PosesHeld(20, 50), 0, kHeldTestFrames, ImagesTowardsAWall(true));
  for (std::size_t i = 0; i < kHeldTestFrames; ++i) {
    if (i <= 30 || i >= 50) {
      EXPECT_FALSE(held[i]) << i;
    }
    if (i >= 33 && i < 50) {
      EXPECT_TRUE(held[i]) << i;
    }
  }
}

TEST(HeldFrames, ImagesBehindThePartAreNotRead) {
  std::size_t last = 0;
  const ImageOfFrame images = ImagesTowardsAWall();
  const std::vector<bool> held = HeldFrames(PosesHeld(20, 40), 0, 30, [&](std::size_t i) {
    last = std::max(last, i);
    return images(i);
  });
  EXPECT_LT(last, 30U);
  EXPECT_TRUE(held[28]);
}

// A tracker that has not begun gives its first pose: right is the one it begins at.
TEST(HeldFrames, AtTheStartAreThoseBeforeTheLast) {
  const std::vector<bool> held =
      HeldFrames(PosesHeld(0, 30), 0, kHeldTestFrames, ImagesTowardsAWall());
  for (std::size_t i = 0; i < kHeldTestFrames; ++i) {
    EXPECT_EQ(held[i], i < 29) << i;
  }
}

// Poses of a tracker that answers every third frame.
TEST(HeldFrames, AreAllButTheFirstOfPosesReadTooOften) {
  std::vector<std::optional<Pose3>> poses = PosesHeld(0, 0);
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) poses[i] = poses[i / 3 * 3];
  const std::vector<bool> held = HeldFrames(
      poses, 0, kHeldTestFrames, [](std::size_t) { return std::shared_ptr<const DepthImage>(); });
  EXPECT_FALSE(held[30]);
  EXPECT_TRUE(held[31]);
  EXPECT_TRUE(held[32]);
  EXPECT_FALSE(held[33]);
}

TEST(HeldFrames, AreNotThoseOfACameraThatStands) {
  const auto none = [](const std::vector<bool>& held) {
    return std::none_of(held.begin(), held.end(), [](bool is_held) { return is_held; });
  };
  EXPECT_TRUE(none(HeldFrames(PosesHeld(0, 30), 0, kHeldTestFrames, ImagesTowardsAWall(true))));
  EXPECT_TRUE(none(HeldFrames(PosesHeld(0, 0), 0, kHeldTestFrames, ImagesTowardsAWall())));
  EXPECT_TRUE(none(HeldFrames(PosesHeld(20, 22), 0, kHeldTestFrames,
                              ImagesTowardsAWall())));  // two images near one
  EXPECT_TRUE(
      none(HeldFrames(PosesHeld(20, 40), 0, kHeldTestFrames, [](std::size_t) { return nullptr; })));
  // A recording without any motion is named by the check of its poses.
  EXPECT_TRUE(none(HeldFrames(std::vector<std::optional<Pose3>>(kHeldTestFrames, Pose3{}), 0,
                              kHeldTestFrames, ImagesTowardsAWall())));
}

}  // namespace
}  // namespace depthgrid
