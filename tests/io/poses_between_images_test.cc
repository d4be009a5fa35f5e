// Poses that come at other times than the images.
#include <gmock/gmock.h>

#include "mapper/io/frame_names.h"
#include "mapper/io/slam_files.h"
#include "mapper/io/trajectory_file.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

class PosesBetweenImages : public TemporaryFolderTest {};

// Ten a second, each halfway between two images.
TEST_F(PosesBetweenImages, StandForImagesBetweenThem) {
  FrameNames frames;
  Trajectory poses;
  for (int i = 0; i < 12; ++i) {
    frames.stamps_s.push_back(0.1 * i);
    poses.push_back({0.1 * i + 0.05, Pose3{}});
  }
  WriteTrajectory(Path("live.txt"), poses);
  const SlamInput input = ReadSlamFiles({Path("live.txt"), "", ""}, frames, {0.02, true, 0.2});
  EXPECT_FALSE(input.slam.live[0].slam_from_camera);
  for (std::size_t i = 1; i < 12; ++i) EXPECT_TRUE(input.slam.live[i].slam_from_camera) << i;
  EXPECT_THAT(RefusalOf([&] {
                ReadSlamFiles({Path("live.txt"), "", ""}, frames, {0.02, false, 0.2});
              }),
              HasSubstr("no pose within 0.02 s of any image"));
}

// A loop moves the poses by a metre at the seventh of them, at 0.78 s. No image is between the two
// poses of one motion there: spread over the images, the metre would look like a fast motion.
TEST_F(PosesBetweenImages, TheirCorrectionIsNoMotion) {
  FrameNames frames;
  for (int i = 0; i < 60; ++i) frames.stamps_s.push_back(0.03 * i + 0.003);
  Trajectory poses;
  for (int i = 0; i < 15; ++i) {
    Pose3 pose;
    pose.translation.x() = 0.05 * i + (i < 6 ? 0.0 : 1.0);
    poses.push_back({0.13 * i, pose});
  }
  WriteTrajectory(Path("live.txt"), poses);
  const SlamInput input = ReadSlamFiles({Path("live.txt"), "", ""}, frames, {0.02, true, 0.2});
  EXPECT_THAT(input.notes, testing::Contains(HasSubstr("corrected itself at 1 frame")));
  int posed = 0;
  for (const SlamPose& frame : input.slam.live) {
    const bool after = frame.stamp_s > 0.78;
    EXPECT_EQ(frame.epoch, after ? 1 : 0) << frame.stamp_s;
    if (!frame.slam_from_camera) continue;
    ++posed;
    EXPECT_NEAR(frame.slam_from_camera->translation.x(),
                0.05 * frame.stamp_s / 0.13 + (after ? 1.0 : 0.0), 1e-6);
  }
  // All but the four between 0.65 and 0.78 s.
  EXPECT_EQ(posed, 56);
}

TEST_F(PosesBetweenImages, EachSecondImageMayLackOne) {
  EXPECT_TRUE(LacksEachSecondPose({true, false, true, false, true, false}));
  EXPECT_FALSE(LacksEachSecondPose({true, true, true, false, false, false}));
  EXPECT_FALSE(LacksEachSecondPose({true, true, true, false, true, true}));
}

}  // namespace
}  // namespace depthgrid
