// Parts of a map that leave SLAM's path.
#include "mapper/astray_parts.h"

#include <gtest/gtest.h>

#include "mapper/graph/place.h"

namespace depthgrid {
namespace {

constexpr double kRatio = 8.0;
constexpr int kPathFrames = 400;
constexpr int kAstrayFrom = 200, kAstrayTo = 240;
constexpr double kFrameM = 0.02;

// Straight on, the map's way 1 % longer than SLAM's; over 40 frames SLAM's is all there is, and the
// map stands still.
std::vector<MappedFrame> PathThatStands() {
  std::vector<MappedFrame> frames;
  Pose2 map_from_base;
  for (int i = 0; i < kPathFrames; ++i) {
    MappedFrame frame;
    frame.frame = i;
    frame.stamp_s = i / 30.0;
    if (i > 0) frame.slam_motion = Pose2{kFrameM, 0.0, 0.0};
    const bool stands = i > kAstrayFrom && i <= kAstrayTo;
    if (i > 0 && !stands) map_from_base = map_from_base * Pose2{1.01 * kFrameM, 0.0, 0.0};
    frame.map_from_base = map_from_base;
    frames.push_back(frame);
  }
  return frames;
}

TEST(AstrayParts, AreWhereTheMapLeavesSlamsPath) {
  const std::vector<MappedFrame> frames = PathThatStands();
  const std::vector<AstrayPart> parts = AstrayPartsOf(frames, kRatio);
  ASSERT_EQ(parts.size(), 1U);
  const AstrayPart& part = parts.front();
  EXPECT_LE(part.first, kAstrayFrom);
  EXPECT_GE(part.first, kAstrayFrom - 25);
  EXPECT_GE(part.last, kAstrayTo);
  EXPECT_LE(part.last, kAstrayTo + 25);
  EXPECT_NEAR(part.apart_m, (kAstrayTo - kAstrayFrom) * kFrameM, 0.02);
  EXPECT_GT(part.apart_m, kRatio * part.usual_m);
}

TEST(AstrayParts, AreNoneWhereItIsAsFarFromItAsUsual) {
  EXPECT_TRUE(AstrayPartsOf({}, kRatio).empty());
  EXPECT_TRUE(AstrayPartsOf(PathThatStands(), 1000.0).empty());
  std::vector<MappedFrame> frames = PathThatStands();
  frames.resize(kAstrayFrom);
  EXPECT_TRUE(AstrayPartsOf(frames, kRatio).empty());
}

// A new epoch of SLAM tells no motion.
TEST(AstrayParts, DoNotSpanAnEpoch) {
  std::vector<MappedFrame> frames = PathThatStands();
  for (int i = kAstrayFrom + 1; i <= kAstrayTo; ++i) {
    frames[static_cast<std::size_t>(i)].slam_motion.reset();
  }
  EXPECT_TRUE(AstrayPartsOf(frames, kRatio).empty());
}

TEST(AstrayParts, AreNotOfAPriorMapOrOfTiedFrames) {
  std::vector<MappedFrame> frames = PathThatStands();
  for (MappedFrame& frame : frames) frame.frame -= kPathFrames;
  EXPECT_TRUE(AstrayPartsOf(frames, kRatio).empty());
  frames = PathThatStands();
  for (MappedFrame& frame : frames) frame.tied_to = frame.frame > kAstrayFrom ? 0 : -1;
  EXPECT_TRUE(AstrayPartsOf(frames, kRatio).empty());
}

TEST(AstrayParts, FollowSlamWithAllThatComesAfter) {
  const std::vector<MappedFrame> frames = PathThatStands();
  const std::vector<AstrayPart> parts = AstrayPartsOf(frames, kRatio);
  ASSERT_EQ(parts.size(), 1U);
  const AstrayPart& part = parts.front();
  const std::vector<Pose2> followed = FollowingSlam(frames, part);
  ASSERT_EQ(followed.size(), frames.size());
  for (int i = 1; i < kPathFrames; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool within = i > part.first && i <= part.last;
    const double way_m = Between(followed[k - 1], followed[k]).x_m;
    const double before_m = Between(PoseAt(frames, i - 1), PoseAt(frames, i)).x_m;
    EXPECT_NEAR(way_m, within ? kFrameM : before_m, 1e-9) << i;
  }
}

}  // namespace
}  // namespace depthgrid
