#include "mapper/scan/held_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

constexpr int kWatchedFrames = 70;

// The frame whose pose SLAM gives with frame i.
using PoseOfFrame = std::function<int(int)>;

// An image of a wall that is nearer by 3 cm each frame after `stands_until`. Noise of 1 cm.
Frame TowardsWall(int i, int pose_of, int stands_until = 0) {
  auto image = std::make_shared<DepthImage>(64, 48);
  RandomStream random(static_cast<std::uint64_t>(i), RandomStage::kTest);
  for (float& z_m : image->z_m) {
    z_m = static_cast<float>(5.0 - 0.03 * std::max(i - stands_until, 0) + 0.01 * random.Normal());
  }
  Frame frame;
  frame.index = i;
  frame.stamp_s = i / 15.0;
  frame.depth = image;
  frame.slam_from_camera = CameraOf({0.03 * pose_of, 0.0, 0.0}, 1.0);
  return frame;
}

std::vector<bool> HeldAmong(const PoseOfFrame& pose_of, int stands_until = 0) {
  HeldWatch watch;
  std::vector<bool> held;
  for (int i = 0; i < kWatchedFrames; ++i) {
    held.push_back(watch.IsHeld(TowardsWall(i, pose_of(i), stands_until)));
  }
  return held;
}

int CountOf(const std::vector<bool>& held) {
  return static_cast<int>(std::count(held.begin(), held.end(), true));
}

TEST(HeldWatch, TellsAPoseThatStaysWhileTheViewMoves) {
  const std::vector<bool> held = HeldAmong([](int i) { return i > 30 && i < 50 ? 30 : i; });
  for (int i = 0; i < kWatchedFrames; ++i) {
    if (i < 32 || i >= 50) {
      EXPECT_FALSE(held[static_cast<std::size_t>(i)]) << i;
    }
    if (i >= 35 && i < 50) {
      EXPECT_TRUE(held[static_cast<std::size_t>(i)]) << i;
    }
  }
}

TEST(HeldWatch, BelievesARobotThatStands) {
  EXPECT_EQ(CountOf(HeldAmong([](int i) { return std::max(i, 20); }, 20)), 0);
  EXPECT_EQ(CountOf(HeldAmong([](int i) { return i < 20 ? i : 20; }, kWatchedFrames)), 0);
}

// The robot stops at frame 20 before a wall. From frame 45 on the left part of its image, so many
// columns of 64, is nearer by so much in each frame.
int HeldAfterStanding(int columns, double nearer_m) {
  HeldWatch watch;
  std::vector<bool> held;
  for (int i = 0; i < kWatchedFrames; ++i) {
    Frame frame = TowardsWall(i, std::min(i, 20), kWatchedFrames);
    auto image = std::make_shared<DepthImage>(*frame.depth);
    for (int v = 0; v < 48 && i >= 45; ++v) {
      for (int u = 0; u < columns; ++u) {
        image->z_m[static_cast<std::size_t>(64 * v + u)] -= static_cast<float>(nearer_m * (i - 44));
      }
    }
    frame.depth = image;
    held.push_back(watch.IsHeld(frame));
  }
  return CountOf(held);
}

// Who comes before it only hides what it saw; motion uncovers something.
TEST(HeldWatch, BelievesARobotThatStoodWhenSomebodyFillsItsView) {
  EXPECT_EQ(HeldAfterStanding(50, 0.1), 0);
  EXPECT_GT(HeldAfterStanding(50, -0.1), 20);
}

// As of a log without odometry.
TEST(HeldWatch, BelievesPosesThatNeverMoved) {
  EXPECT_EQ(CountOf(HeldAmong([](int) { return 0; })), 0);
}

TEST(HeldWatch, BelievesPosesThatAreReadMoreOftenThanMade) {
  EXPECT_EQ(CountOf(HeldAmong([](int i) { return i / 2 * 2; })), 0);
  const std::vector<bool> held = HeldAmong([](int i) { return i / 7 * 7; });
  EXPECT_EQ(CountOf({held.begin() + 40, held.end()}), 0);
}

// A laser that drives along a room; odometry stops being counted for a second while it turns.
FrameReport LastOf(bool holds) {
  const PlanarWorld room = FurnishedRoom();
  IncrementalMapper mapper({}, std::nullopt);
  FrameReport last;
  PlanarLaser laser;
  laser.beams = 320;
  Pose2 odometry;
  for (int i = 0; i < 80; ++i) {
    const Pose2 world_from_laser{1.5 + 0.03 * i, 1.5 + 0.01 * i, 0.02 * i};
    Frame frame;
    frame.index = i;
    frame.stamp_s = 0.05 * i;
    frame.scan = std::make_shared<const Scan>(ScanOf(room, world_from_laser, laser));
    if (!holds || i <= 40 || i >= 60) odometry = world_from_laser;
    frame.slam_from_camera = CameraOf(odometry, 0.0);
    last = mapper.AddFrame(frame);
  }
  return last;
}

TEST(HeldWatch, LetsTheMapperGoOnWhereSlamIs) {
  const FrameReport right = LastOf(false), held = LastOf(true);
  const Pose2 off = Between(BaseOf(*right.map_from_camera), BaseOf(*held.map_from_camera));
  EXPECT_LT(off.translation().norm(), 0.02);
  EXPECT_LT(std::abs(off.yaw_rad), 0.01);
}

// Farthest that the online poses are off where a pose of the odometry is passed with each scan
// until the next one comes, every `run` scans.
double WorstSlowErrorM(int run) {
  const PlanarWorld room = FurnishedRoom();
  IncrementalMapper mapper({}, std::nullopt);
  PlanarLaser laser;
  laser.beams = 320;
  laser.sigma_of_range = 0.01;
  const auto truth = [](int i) {
    const double angle_rad = 2.0 * kPi * i / 300;
    return Pose2{3.0 + 0.9 * std::cos(angle_rad), 1.7 + 0.6 * std::sin(angle_rad),
                 WrapAngle(angle_rad + 0.5 * kPi)};
  };
  double worst_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan = std::make_shared<const Scan>(
        ScanOf(room, truth(i), laser, 4, static_cast<std::uint32_t>(i)));
    frame.slam_from_camera = CameraOf(truth(i / run * run), 0.0);
    const FrameReport report = mapper.AddFrame(frame);
    if (!report.map_from_camera || i < 60) continue;
    const Pose2 pose = BaseOf(*report.map_from_camera);
    worst_m = std::max(worst_m, (pose.translation() - truth(i).translation()).norm());
  }
  return worst_m;
}

TEST(HeldWatch, OdometrySlowerThanTheScansIsMovedOn) { EXPECT_LT(WorstSlowErrorM(6), 0.06); }

TEST(HeldWatch, MovesOnWhatRepeatsForAsLongAsAStepTook) {
  HeldWatch watch;
  std::vector<std::optional<Pose3>> moved_on;
  for (int i = 0; i < 33; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = 0.1 * i;
    frame.slam_from_camera = CameraOf({i < 24 ? 0.1 * (i / 4) : 0.6, 0.0, 0.0}, 0.0);
    EXPECT_FALSE(watch.IsHeld(frame));
    moved_on.push_back(watch.MovedOn());
  }
  EXPECT_FALSE(moved_on[6]);   // one run is too few
  EXPECT_FALSE(moved_on[12]);  // a new pose
  for (const auto& [i, x_m] : {std::pair{13, 0.325}, {15, 0.375}, {25, 0.625}, {30, 0.7}}) {
    ASSERT_TRUE(moved_on[static_cast<std::size_t>(i)]) << i;
    EXPECT_NEAR(BaseOf(*moved_on[static_cast<std::size_t>(i)]).x_m, x_m, 1e-9) << i;
  }
  EXPECT_FALSE(moved_on[32]);  // longer than twice the usual time: it stands
}

TEST(HeldWatch, GivesNoPoseToAFrameWithoutOne) {
  HeldWatch watch;
  Frame frame;
  for (int i = 0; i < 15; ++i) {
    frame.index = i;
    frame.stamp_s = 0.1 * i;
    frame.slam_from_camera = CameraOf({0.1 * (i / 4), 0.0, 0.0}, 0.0);
    watch.IsHeld(frame);
  }
  EXPECT_TRUE(watch.MovedOn());
  frame.index = 15;
  frame.stamp_s = 1.5;
  frame.slam_from_camera.reset();  // SLAM is lost
  watch.IsHeld(frame);
  EXPECT_FALSE(watch.MovedOn());
}

}  // namespace
}  // namespace depthgrid
