// Depth images through the whole mapper, at true poses.
#include <gtest/gtest.h>

#include "mapper/incremental_mapper.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

// A hand-held walk round the room, turning, looking down a little, pitching and rolling.
std::vector<Pose3> CameraWalk(int count) {
  std::vector<Pose3> poses;
  for (int i = 0; i < count; ++i) {
    const double angle_rad = 2.0 * kPi * i / count;
    const Pose2 base{0.8 * std::cos(angle_rad), 0.7 * std::sin(angle_rad),
                     WrapAngle(3.0 * angle_rad)};
    poses.push_back(TiltedCamera(base, 1.15, RadFromDeg(10.0 + 8.0 * std::sin(5.0 * angle_rad)),
                                 RadFromDeg(6.0 * std::cos(7.0 * angle_rad))));
  }
  return poses;
}

MapperOptions SlamAlone() {
  MapperOptions options;
  options.fusion.mode = FusionMode::kFixed;
  options.fusion.gain = {0.0, 0.0, 0.0};
  return options;
}

TEST(DepthMapping, DrawsTheRoomAsItIs) {
  AnalyticRoom room;
  room.walls = {{-2.98, -2.48, 0.0}, {2.98, 2.48, 2.5}};  // not on cell boundaries
  room.boxes.push_back({{1.52, 1.12, 0.0}, {2.22, 1.92, 0.45}});
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  IncrementalMapper mapper(SlamAlone(), camera);
  Frame frame;
  for (const Pose3& pose : CameraWalk(120)) {
    frame.depth = std::make_shared<DepthImage>(room.Render(camera, pose));
    frame.slam_from_camera = pose;
    mapper.AddFrame(frame);
    ++frame.index;
    frame.stamp_s += 1.0 / 30.0;
  }
  const OccupancyMap map = mapper.Finish().map;
  const StateMap states = StatesOf(map);
  int occupied = 0, right = 0, free = 0, inside = 0;
  for (int x = -70; x < 70; ++x) {
    for (int y = -60; y < 60; ++y) {
      const Cell cell{x, y};
      const Eigen::Vector2d centre = CellCentre(cell, 0.05);
      const auto in = [&](double x0, double y0, double x1, double y1) {
        return centre.x() > x0 && centre.x() < x1 && centre.y() > y0 && centre.y() < y1;
      };
      const bool in_box = in(1.5, 1.1, 2.25, 1.95);
      const bool box_core = in(1.55, 1.15, 2.2, 1.9);
      const bool in_room = in(-2.95, -2.45, 2.95, 2.45);
      const bool surface = (in(-3.0, -2.5, 3.0, 2.5) && !in_room) || (in_box && !box_core);
      if (states.At(cell) == CellState::kOccupied) {
        ++occupied;
        right += surface || in_box ? 1 : 0;  // the top of the box is an obstacle too
      }
      if (in_room && !in_box) {
        ++inside;
        free += states.At(cell) == CellState::kFree ? 1 : 0;
      }
    }
  }
  EXPECT_GT(occupied, 400);
  EXPECT_EQ(right, occupied);
  // The rest: the box's shadow, and the middle, which no pose sees from far enough to see its
  // floor.
  EXPECT_GT(free, 0.9 * inside);
}

TEST(DepthMapping, AFrameWithoutPoseOrImageIsSurvived) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  IncrementalMapper mapper(SlamAlone(), camera);
  const AnalyticRoom room;
  Frame frame;
  const Pose3 pose = CameraOf({}, 1.15);
  frame.depth = std::make_shared<DepthImage>(room.Render(camera, pose));
  EXPECT_FALSE(mapper.AddFrame(frame).inserted);
  frame.index = 1;
  frame.stamp_s = 0.1;
  frame.slam_from_camera = pose;
  EXPECT_TRUE(mapper.AddFrame(frame).inserted);
  frame.index = 2;
  frame.stamp_s = 0.2;
  frame.depth.reset();
  EXPECT_FALSE(mapper.AddFrame(frame).inserted);
  EXPECT_EQ(mapper.Finish().mapped.size(), 1U);
}

}  // namespace
}  // namespace depthgrid
