#include "mapper/io/slam_jumps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "mapper/core/angle.h"
#include "mapper/io/slam_files.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr int kJumpFrames = 240;
constexpr int kJumpAt = 200;

// A circle of 1 m radius, walked in 6 s and a third of it again, looking along the path.
Pose3 OnCircle(int frame) {
  const double angle_rad = 2.0 * kPi * frame / 180.0;
  return {ExpRotation(Eigen::Vector3d(0.0, 0.0, angle_rad)),
          {std::cos(angle_rad), std::sin(angle_rad), 1.2}};
}

// SLAM drifted by up to 0.3 m and jumps back when it closes the circle, a bit late.
std::vector<SlamPose> Drifting() {
  std::vector<SlamPose> live;
  for (int i = 0; i < kJumpFrames; ++i) {
    Pose3 pose = OnCircle(i);
    if (i < kJumpAt) pose.translation.x() += 0.3 * i / kJumpAt;
    live.push_back({i / 30.0, pose, 0});
  }
  return live;
}

Trajectory Revised() {
  Trajectory final;
  for (int i = 0; i < kJumpFrames; ++i) final.push_back({i / 30.0, OnCircle(i)});
  return final;
}

TEST(SlamJumps, PosesThatHardlyDoAnythingElseAreDoubted) {
  std::vector<SlamPose> live = Drifting();
  EXPECT_EQ(DoubtOf(live, FindJumps(live, {})), std::nullopt);
  for (SlamPose& pose : live) pose.slam_from_camera->translation *= 1000.0;  // millimetres
  EXPECT_EQ(DoubtOf(live, {}),  // a turn in 6 s is 1.05 m/s
            "the camera moves at 1047 m/s: are the poses in metres, and the stamps in seconds?");
  std::vector<SlamPose> shaken = Drifting();
  for (std::size_t i = 0; i < shaken.size(); i += 2) {
    shaken[i].slam_from_camera->translation.z() += 0.3;
  }
  const auto doubt = DoubtOf(shaken, FindJumps(shaken, {}));
  ASSERT_TRUE(doubt);
  EXPECT_THAT(*doubt, testing::HasSubstr(" of 239 steps are jumps: are the poses in metres"));
  live.resize(4);  // three steps say nothing
  EXPECT_EQ(DoubtOf(live, FindJumps(live, {})), std::nullopt);
}

// As of a recording with a frame a second: whether it is one, the stamps do not tell.
TEST(SlamJumps, OfWholeStampsAreDoubtedWithBothTheirMeanings) {
  std::vector<SlamPose> live;
  for (int i = 0; i < 30; ++i) {
    const double x_m = i % 4 == 1 || i % 4 == 2 ? 0.8 : 0.0;  // round a square
    const double y_m = i % 4 >= 2 ? 0.8 : 0.0;
    live.push_back(
        {static_cast<double>(i), Pose3{Eigen::Quaterniond::Identity(), {x_m, y_m, 0}}, 0});
  }
  const auto whole = DoubtOf(live, FindJumps(live, {}));
  ASSERT_TRUE(whole.has_value());
  EXPECT_THAT(*whole, testing::StartsWith("29 of 29 steps would be jumps if the stamps, all whole, "
                                          "count images at 30 Hz: are the poses in metres"));
  EXPECT_THAT(*whole, testing::HasSubstr("If they are seconds, nothing is amiss"));
  std::vector<SlamPose> dated = live;
  for (SlamPose& pose : dated) pose.stamp_s += 1305031100.0;  // seconds since 1970
  EXPECT_THAT(FindJumps(dated, {}), IsEmpty());
  live.back().stamp_s += 0.25;  // they are seconds
  EXPECT_EQ(DoubtOf(live, FindJumps(live, {})), std::nullopt);
}

TEST(SlamJumps, AreSeenWithAndWithoutARevisedTrajectory) {
  EXPECT_THAT(FindJumps(Drifting(), Revised()), ElementsAre(kJumpAt));
  EXPECT_THAT(FindJumps(Drifting(), {}), ElementsAre(kJumpAt));
}

// ICL-NUIM's stamps are the images' numbers, 30 a second.
TEST(SlamJumps, AreSeenBetweenNumberedStamps) {
  std::vector<SlamPose> live = Drifting();
  for (std::size_t i = 0; i < live.size(); ++i) live[i].stamp_s = static_cast<double>(i + 1);
  EXPECT_THAT(FindJumps(live, {}), ElementsAre(kJumpAt));
}

TEST(SlamJumps, SmoothMotionAndGapsAreNone) {
  std::vector<SlamPose> live = Drifting();
  live.resize(kJumpAt);
  EXPECT_THAT(FindJumps(live, {}), IsEmpty());
  for (int i = 60; i < 90; ++i) live[static_cast<std::size_t>(i)].slam_from_camera.reset();
  EXPECT_THAT(FindJumps(live, {}), IsEmpty());
  EXPECT_THAT(FindJumps(live, Revised()), IsEmpty());
  EXPECT_THAT(FindJumps({}, {}), IsEmpty());
}

// Frame 200 is where frame 20 was, to the last digit.
TEST(SlamJumps, TheLoopIsTheRevisedPosesOfBothVisits) {
  const auto loops = LoopsFromRevision(Drifting(), Revised(), {kJumpAt});
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].first_frame, 20);
  EXPECT_EQ(loops[0].second_frame, kJumpAt);
  EXPECT_EQ(loops[0].reported_at_frame, kJumpAt);
  EXPECT_LT(loops[0].first_from_second.translation.norm(), 1e-9);
}

TEST(SlamJumps, APlaceNeverSeenBeforeHasNoLoop) {
  EXPECT_THAT(LoopsFromRevision(Drifting(), Revised(), {100}), IsEmpty());
}

TEST(SlamJumps, AJumpThatWasNotRevisedHasNoLoop) {
  Trajectory revised = Revised();
  revised.erase(revised.begin() + kJumpAt);
  EXPECT_THAT(LoopsFromRevision(Drifting(), revised, {kJumpAt}), IsEmpty());
}

TEST(SlamJumps, EpochsCountUpFromEachJump) {
  std::vector<SlamPose> live(5);
  StartEpochs({2, 4}, live);
  std::vector<int> epochs;
  for (const SlamPose& pose : live) epochs.push_back(pose.epoch);
  EXPECT_THAT(epochs, ElementsAre(0, 0, 1, 1, 2));
}

// Its loop was found at frame 788; the poses moved by 0.24 m with frame 790.
TEST(SlamJumps, RealOrbSlamOutput) {
  const char* data = std::getenv("DEPTHGRID_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "DEPTHGRID_TEST_DATA is not set";
  const std::string folder = std::string(data) + "/slam_runs/orb_rich_a/";
  std::vector<double> stamps_s;
  for (const StampedPose& pose : ReadTrajectory(folder + "live.txt")) {
    stamps_s.push_back(pose.stamp_s);
  }
  const SlamFilePaths paths{folder + "live.txt", folder + "CameraTrajectory.txt", ""};
  const SlamInput revised = ReadSlamFiles(paths, {stamps_s});
  EXPECT_THAT(FindJumps(ReadSlamFiles({paths.live, "", ""}, {stamps_s}).slam.live, {}),
              Contains(790));
  ASSERT_FALSE(revised.slam.loops.empty());
  EXPECT_EQ(revised.slam.live[787].epoch, 0);
  EXPECT_GE(revised.slam.live[790].epoch, 1);
  const SlamInput told =
      ReadSlamFiles({paths.live, paths.final, folder + "events.txt"}, {stamps_s});
  ASSERT_EQ(told.slam.loops.size(), 1U);
  const LoopClosure& loop = told.slam.loops[0];
  EXPECT_EQ(loop.first_frame, 2);
  EXPECT_EQ(loop.second_frame, 788);
  // What its own final poses say of the same two frames.
  const Pose3 final =
      Between(told.slam.final[2].world_from_camera, told.slam.final[788].world_from_camera);
  EXPECT_LT((loop.first_from_second.translation - final.translation).norm(), 0.02);
}

}  // namespace
}  // namespace depthgrid
