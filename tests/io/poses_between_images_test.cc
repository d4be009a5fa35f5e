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

TEST_F(PosesBetweenImages, EachSecondImageMayLackOne) {
  EXPECT_TRUE(LacksEachSecondPose({true, false, true, false, true, false}));
  EXPECT_FALSE(LacksEachSecondPose({true, true, true, false, false, false}));
  EXPECT_FALSE(LacksEachSecondPose({true, true, true, false, true, true}));
}

}  // namespace
}  // namespace depthgrid
