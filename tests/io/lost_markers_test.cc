#include "mapper/io/lost_markers.h"

#include <gmock/gmock.h>

#include "mapper/io/slam_files.h"
#include "mapper/io/slam_jumps.h"
#include "mapper/io/trajectory_file.h"
#include "tests/io/temporary_folder.h"

namespace depthgrid {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A walk from the origin, 2 cm a frame.
std::vector<SlamPose> Walk(int frames) {
  std::vector<SlamPose> live;
  for (int i = 0; i < frames; ++i) {
    Pose3 pose;
    pose.translation.x() = 0.02 * i;
    live.push_back({i / 30.0, pose, 0});
  }
  return live;
}

TEST(LostMarkers, AreIdentitiesBetweenTwoJumps) {
  std::vector<SlamPose> live = Walk(60);
  for (const int i : {30, 31, 33}) live[static_cast<std::size_t>(i)].slam_from_camera = Pose3{};
  live[32].slam_from_camera.reset();
  EXPECT_THAT(FindLostMarkers(live), ElementsAre(30, 31, 33));
  Forget(FindLostMarkers(live), live);
  EXPECT_FALSE(live[31].slam_from_camera);
  EXPECT_THAT(FindJumps(live, {}), IsEmpty());  // SLAM goes on in its old world
}

TEST(LostMarkers, MayEndARecording) {
  std::vector<SlamPose> live = Walk(40);
  live[38].slam_from_camera = live[39].slam_from_camera = Pose3{};
  EXPECT_THAT(FindLostMarkers(live), ElementsAre(38, 39));
}

// A camera that stands where it begins, one that comes back to there, and a SLAM that is started
// again and goes on from the origin.
TEST(LostMarkers, AreNotWhereTheCameraIsOrSlamBegins) {
  std::vector<SlamPose> stands = Walk(40);
  for (std::size_t i = 0; i < 10; ++i) stands[i].slam_from_camera = Pose3{};
  EXPECT_THAT(FindLostMarkers(stands), IsEmpty());

  std::vector<SlamPose> returns = Walk(40);
  for (const SlamPose& pose : Walk(40)) returns.push_back(pose);
  for (std::size_t i = 40; i < 80; ++i) {
    returns[i] = {static_cast<double>(i) / 30.0, returns[79 - i].slam_from_camera, 0};
  }
  EXPECT_THAT(FindLostMarkers(returns), IsEmpty());

  std::vector<SlamPose> restarts = Walk(60);
  const std::vector<SlamPose> again = Walk(30);
  for (std::size_t i = 30; i < 60; ++i) {
    restarts[i].slam_from_camera = again[i - 30].slam_from_camera;
  }
  EXPECT_THAT(FindLostMarkers(restarts), IsEmpty());
  EXPECT_THAT(FindJumps(restarts, {}), ElementsAre(30));
}

class LostMarkerFiles : public TemporaryFolderTest {};

TEST_F(LostMarkerFiles, LeaveFramesWithoutAPose) {
  std::vector<SlamPose> live = Walk(60);
  FrameNames frames;
  Trajectory poses;
  for (std::size_t i = 0; i < live.size(); ++i) {
    frames.stamps_s.push_back(live[i].stamp_s);
    if (i >= 30 && i < 40) live[i].slam_from_camera = Pose3{};
    poses.push_back({live[i].stamp_s, *live[i].slam_from_camera});
  }
  WriteTrajectory(Path("live.txt"), poses);
  for (const bool interpolate : {false, true}) {
    const SlamInput input =
        ReadSlamFiles({Path("live.txt"), "", ""}, frames, {0.02, interpolate, 0.2});
    EXPECT_THAT(input.warnings,
                Contains(HasSubstr("live.txt: 10 poses at the identity, far from")));
    EXPECT_THAT(input.notes, IsEmpty());
    for (std::size_t i = 0; i < live.size(); ++i) {
      EXPECT_EQ(input.slam.live[i].slam_from_camera.has_value(), i < 30 || i >= 40) << i;
      EXPECT_EQ(input.slam.live[i].epoch, 0);
    }
  }
}

}  // namespace
}  // namespace depthgrid
