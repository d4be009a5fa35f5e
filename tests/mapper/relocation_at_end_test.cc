// A camera that comes back to what it had seen with the last metre of the run.
#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr int kToured = 240, kElsewhere = 80, kBackAgain = 40;

// Round the first room; then, since the loss, west through the second one and into the first.
Pose2 PoseInTwoRooms(int frame) {
  if (frame < kToured) {
    const double angle_rad = 2.0 * kPi * frame / kToured;
    return {3.0 + 0.7 * std::cos(angle_rad), 1.7 + 0.7 * std::sin(angle_rad),
            WrapAngle(angle_rad + 0.5 * kPi)};
  }
  const int since = frame - kToured;
  if (since < kElsewhere) return {9.2 - 2.6 * since / kElsewhere, 1.6, kPi - 1e-9};
  return {5.5 - 1.2 * (since - kElsewhere) / kBackAgain, 1.6, kPi - 1e-9};
}

TEST(RelocationAtEnd, TheLastMetreIsSearchedForAlone) {
  PlanarWorld world = FurnishedRoom();
  AddRectangle(world, 6.2, 0.0, 9.8, 5.0);
  AddRectangle(world, 7.0, 3.0, 8.1, 3.7);
  AddRectangle(world, 8.6, 0.0, 9.1, 0.6);
  const Pose2 restart{1.6, -0.7, 0.9};
  const int count = kToured + kElsewhere + kBackAgain;
  IncrementalMapper mapper({}, std::nullopt);
  bool last_guessed = false;
  for (int i = 0; i < count; ++i) {
    const Pose2 truth = PoseInTwoRooms(i);
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0 + (i < kToured ? 0.0 : 5.0);
    frame.slam_epoch = i < kToured ? 0 : 1;
    frame.slam_from_camera = CameraOf(i < kToured ? truth : restart * truth, 1.0);
    const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
    frame.scan =
        std::make_shared<const Scan>(ScanOf(world, truth, laser, 4, static_cast<std::uint32_t>(i)));
    last_guessed = mapper.AddFrame(frame).guessed;
  }
  EXPECT_TRUE(last_guessed);  // of three metres most is of the room never seen
  const MapperResult result = mapper.Finish();
  EXPECT_TRUE(result.guessed.empty());
  for (int i = kToured; i < count; ++i) {
    const Pose2 pose = BaseOf(*result.map_from_camera[static_cast<std::size_t>(i)]);
    // Metres as guessed; in the second room, 3 m on, a heading of 0.01 rad counts.
    ASSERT_LT((pose.translation() - PoseInTwoRooms(i).translation()).norm(), 0.06) << i;
  }
}

}  // namespace
}  // namespace depthgrid
