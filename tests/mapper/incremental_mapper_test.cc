#include "mapper/incremental_mapper.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

constexpr double kCameraHeightM = 1.15;

// Once round a circle of radius 1 m, looking across its centre.
std::vector<Frame> FramesOf(const PlanarWorld& world, int count, const PlanarLaser& laser) {
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) {
    const double angle_rad = 2.0 * kPi * i / count;
    const Pose2 base{std::cos(angle_rad), std::sin(angle_rad), WrapAngle(angle_rad + kPi)};
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera = CameraOf(base, kCameraHeightM);
    frame.scan = std::make_shared<Scan>(ScanOf(world, base, laser));
    frames.push_back(frame);
  }
  return frames;
}

MapperOptions SlamAloneOptions() {
  MapperOptions options;
  options.fusion.mode = FusionMode::kFixed;
  options.fusion.gain = {0.0, 0.0, 0.0};
  return options;
}

MapperResult Mapped(const std::vector<Frame>& frames, const MapperOptions& options) {
  IncrementalMapper mapper(options, std::nullopt);
  for (const Frame& frame : frames) mapper.AddFrame(frame);
  return mapper.Finish();
}

// Chebyshev distance from the cell to the nearest one with state `wanted`, at most 1; 2 if farther.
int NearestWithin1(const StateMap& states, const Cell& cell, CellState wanted) {
  if (states.At(cell) == wanted) return 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (states.At({cell.x + dx, cell.y + dy}) == wanted) return 1;
    }
  }
  return 2;
}

TEST(TruthPoses, TheRoomsOutlineIsFoundAndItsInsideIsFree) {
  const PlanarWorld room = RectangleWorld(-2.45, -2.5, 2.45, 2.5);
  const MapperResult result = Mapped(FramesOf(room, 300, {}), SlamAloneOptions());
  const StateMap states = StatesOf(result.map);
  // Every wall cell has an occupied neighbour, and every occupied cell a wall within one cell.
  int walls = 0, found = 0, occupied = 0, at_a_wall = 0, inside = 0, free = 0;
  for (int x = -49; x < 49; ++x) {
    for (int y = -50; y < 50; ++y) {
      const bool wall = x == -49 || x == 48 || y == -50 || y == 49;
      walls += wall ? 1 : 0;
      found += wall && NearestWithin1(states, {x, y}, CellState::kOccupied) < 2 ? 1 : 0;
      inside += wall ? 0 : 1;
      free += !wall && states.At({x, y}) == CellState::kFree ? 1 : 0;
    }
  }
  for (std::size_t i = 0; i < states.states.size(); ++i) {
    if (states.states[i] != CellState::kOccupied) continue;
    const Cell cell = states.geometry.CellAt(i);
    ++occupied;
    const bool near_x = std::abs(cell.x + 49) <= 1 || std::abs(cell.x - 48) <= 1;
    const bool near_y = std::abs(cell.y + 50) <= 1 || std::abs(cell.y - 49) <= 1;
    at_a_wall += near_x || near_y ? 1 : 0;
  }
  EXPECT_EQ(walls, 392);
  EXPECT_GE(found, 0.99 * walls);
  EXPECT_EQ(at_a_wall, occupied);
  EXPECT_GE(free, 0.98 * inside);
}

TEST(SlamAlone, GivesSlamsPosesBackBitForBit) {
  const PlanarWorld room = RectangleWorld(-2.45, -2.5, 2.45, 2.5);
  std::vector<Frame> frames = FramesOf(room, 50, {.beams = 60});
  frames[7].slam_from_camera->translation.z() = 0.1 + 0.2;
  frames[20].slam_from_camera.reset();  // lost
  frames[21].scan.reset();              // no image
  for (std::size_t i = 30; i < frames.size(); ++i) frames[i].slam_epoch = 1;
  IncrementalMapper mapper(SlamAloneOptions(), std::nullopt);
  for (const Frame& frame : frames) {
    const FrameReport report = mapper.AddFrame(frame);
    EXPECT_EQ(report.map_from_camera, frame.slam_from_camera);
    EXPECT_EQ(report.map_from_slam, Pose2{});
    EXPECT_FALSE(report.match.found);
  }
  const MapperResult result = mapper.Finish();
  ASSERT_EQ(result.map_from_camera.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(result.map_from_camera[i], frames[i].slam_from_camera);
  }
  EXPECT_EQ(result.mapped.size(), 48U);
}

TEST(SlamAlone, TheFinalEstimateIsSlamsFinalTrajectory) {
  const PlanarWorld room = RectangleWorld(-2.45, -2.5, 2.45, 2.5);
  const std::vector<Frame> frames = FramesOf(room, 20, {.beams = 60});
  IncrementalMapper mapper(SlamAloneOptions(), std::nullopt);
  std::vector<std::optional<Pose3>> slam_final;
  for (const Frame& frame : frames) {
    mapper.AddFrame(frame);
    slam_final.push_back(ApplyPlanar({0.1, 0.2, 0.3}, *frame.slam_from_camera));
  }
  slam_final[5].reset();
  const MapperResult result = mapper.Finish(slam_final);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(result.map_from_camera[i], i == 5 ? frames[i].slam_from_camera : slam_final[i]);
    EXPECT_EQ(result.mapped[i].map_from_base, BaseOf(*result.map_from_camera[i]));
  }
}

}  // namespace
}  // namespace depthgrid
