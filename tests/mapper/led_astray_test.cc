// Somebody walks ahead of a robot in a corridor, is taken for a wall and leads the map astray.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr int kDriveFrames = 600;
constexpr double kDriveM = 0.02;  // a frame
constexpr int kComes = 250, kGoes = 310;

// Bare walls with a few doors and boxes.
PlanarWorld CorridorWithNiches() {
  PlanarWorld world = RectangleWorld(-2.0, -1.0, 20.0, 1.0);
  for (const double x : {1.5, 9.5, 14.0}) AddRectangle(world, x, 0.8, x + 0.7, 1.0);
  for (const double x : {3.5, 10.5, 16.0}) AddRectangle(world, x, -1.0, x + 0.5, -0.7);
  return world;
}

Pose2 DrivenTo(int i) {
  return {kDriveM * i, 0.1 * std::sin(0.02 * i), 0.002 * std::cos(0.02 * i)};
}

// What goes ahead of the robot from kComes to kGoes, and how much farther than it SLAM goes then.
struct Drive {
  bool person = false;
  double slip_a_frame_m = 0.0;
};

struct DriveErrors {
  double worst_m = 0.0;
  std::size_t astray = 0;
};

// Nothing that moves is looked for, so the map surely follows who walks ahead.
DriveErrors ErrorsOf(const Drive& drive, double astray_ratio) {
  const PlanarLaser laser{.beams = 320,
                          .field_of_view_rad = RadFromDeg(70),
                          .max_range_m = 5.0,
                          .sigma_of_range = 0.005};
  MapperOptions options;
  options.surfel.moving_m = 0.0;
  options.surfel.match.judge_moving = false;
  options.loops.astray_ratio = astray_ratio;
  IncrementalMapper mapper(options, std::nullopt);
  double slipped_m = 0.0;
  for (int i = 0; i < kDriveFrames; ++i) {
    const Pose2 truth = DrivenTo(i);
    const bool meanwhile = i >= kComes && i < kGoes;
    PlanarWorld world = CorridorWithNiches();
    if (drive.person && meanwhile) {
      const double x = truth.x_m + 1.0;
      AddRectangle(world, x, -0.35, x + 0.3, 0.35);
    }
    if (meanwhile) slipped_m += drive.slip_a_frame_m;
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera =
        CameraOf({truth.x_m * 1.01 + slipped_m, truth.y_m, truth.yaw_rad}, 1.0);
    frame.scan = std::make_shared<const Scan>(
        ScanOf(world, truth, laser, 4, static_cast<std::uint32_t>(i) + 1));
    mapper.AddFrame(frame);
  }
  const MapperResult result = mapper.Finish();
  DriveErrors errors;
  errors.astray = result.astray.size();
  for (int i = 0; i < kDriveFrames; ++i) {
    const Pose2 pose = BaseOf(result.map_from_camera[static_cast<std::size_t>(i)].value());
    const double off_m = (pose.translation() - DrivenTo(i).translation()).norm();
    errors.worst_m = std::max(errors.worst_m, off_m);
  }
  return errors;
}

TEST(LedAstray, TheMapFollowsSlamAgain) {
  const double led_m = ErrorsOf({.person = true}, 0.0).worst_m;
  ASSERT_GT(led_m, 0.3);
  EXPECT_LT(ErrorsOf({.person = true}, 8.0).worst_m, 0.1);
}

// Where SLAM slips what was seen contradicts it.
TEST(LedAstray, IsNotTakenForGrantedWhereSlamSlips) {
  const DriveErrors errors = ErrorsOf({.slip_a_frame_m = 0.01}, 8.0);
  EXPECT_EQ(errors.worst_m, ErrorsOf({.slip_a_frame_m = 0.01}, 0.0).worst_m);
  EXPECT_LT(errors.worst_m, 0.1);
}

TEST(LedAstray, IsNothingWhereNobodyWalks) {
  const DriveErrors errors = ErrorsOf({}, 8.0);
  EXPECT_EQ(errors.worst_m, ErrorsOf({}, 0.0).worst_m);
  EXPECT_EQ(errors.astray, 0U);
}

}  // namespace
}  // namespace depthgrid
